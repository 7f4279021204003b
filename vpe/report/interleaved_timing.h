// Time, measured so that a busy machine hits all that are compared alike.
#pragma once

#include <functional>
#include <limits>
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

// What is timed, and what makes it ready, which is not.
struct BenchmarkCase {
  std::function<void()> run;
  // Before each run, given how long the last one took (NaN: none yet); may be left out.
  std::function<void(double last_s)> prepare;
  // Runs in so many of the rounds that count at most, the first ones, and then not in the one that does not.
  int most_rounds = std::numeric_limits<int>::max();
};

// Runs every contestant once a round, in turns: first one round that does not count, then `rounds` that do. The
// clock is read right before and right after each. Throws std::invalid_argument for rounds < 1.
std::vector<Timing> time_interleaved(std::span<const BenchmarkCase> cases, int rounds,
                                     const Clock& clock = wall_clock());
std::vector<Timing> time_interleaved(std::span<const std::function<void()>> cases, int rounds,
                                     const Clock& clock = wall_clock());

// How many times as long as the other, in the median of the rounds that both have: what disturbs a round
// disturbs both. Throws std::invalid_argument where one has none.
double ratio(const Timing& timing, const Timing& baseline);

// Of an even number the mean of the two in the middle; NaN of none.
double median(std::vector<double> values);

}  // namespace vpe::report
