// Limits and output of programs of this project that run in processes of their own (child_process.h).
//
// Typical usage:
//   limit_this_process(2, 120);
//   const bool is_sent = send_output(bytes);
#pragma once

#include <cstdint>
#include <span>

namespace objects {

inline constexpr double kMostChildTime_s = 1e6;

// Limits the address space, the processor time, and five times as long the time on the clock. Signals SIGXCPU and SIGALRM
// end the process then; memory beyond the limit throws std::bad_alloc. Sanitizers reserve more than any limit: with them
// memory is not limited. time_s must be 1 to kMostChildTime_s.
void limit_this_process(double memory_gb, double time_s);

// Writes to standard output. Returns false if that fails.
bool send_output(std::span<const std::uint8_t> bytes);

// Returns the number that the whole text is, or NaN.
double number_of(const char* text);

}  // namespace objects
