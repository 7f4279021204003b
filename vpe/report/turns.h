// Time, measured so that a busy machine hits all that are compared alike.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace vpe::report {

// Seconds since some moment, never running backwards.
using Clock = std::function<double()>;
Clock wall_clock();

struct Timing {
  std::vector<double> round_s;  // a round each, in their order
  double median_s() const;
};

// Runs every contestant once a round, in turns: first one round that does not count, then `rounds` that do. The
// clock is read right before and right after each. Throws std::invalid_argument for rounds < 1.
std::vector<Timing> time_in_turns(std::span<const std::function<void()>> contestants, int rounds,
                                  const Clock& clock = wall_clock());

// How many times as long as the other, in the median of the rounds: what disturbs a round disturbs both. Throws
// std::invalid_argument for different numbers of rounds.
double ratio(const Timing& timing, const Timing& baseline);

// Of an even number the mean of the two in the middle; NaN of none.
double median(std::vector<double> values);

}  // namespace vpe::report
