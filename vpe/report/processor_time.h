// Processor time: other programs on the machine hardly change it.
#pragma once

#include <cstdint>
#include <ctime>

namespace vpe::report {

// Returns the processor time that all threads of this process have used, ended ones included, in seconds.
inline double processor_s() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Returns the processor time that the calling thread has used, in nanoseconds.
inline std::int64_t thread_processor_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace vpe::report
