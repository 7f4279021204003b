// Processor time: what other programs on the machine hardly change.
#pragma once

#include <ctime>

namespace vpe::app {

// That this process's threads have used so far, those that ended with them, seconds.
inline double processor_s() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace vpe::app
