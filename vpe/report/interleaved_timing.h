// Measures times in interleaved rounds, so that a busy machine slows down all compared cases alike.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace vpe::report {

// Returns seconds since some moment; never runs backwards.
using Clock = std::function<double()>;

// Returns the clock that all processes share.
Clock wall_clock();

struct Timing {
  std::vector<double> round_s;  // one time for each round, in their order

  // Returns the median over the rounds, NaN for none.
  double median_s() const;
};

// A case that is timed, and its preparation, which is not.
struct BenchmarkCase {
  std::function<void()> run;
  // Is called before each run with the time of the last run (NaN: none yet). May be empty.
  std::function<void(double last_s)> prepare;
  // Limits the timed rounds that the case runs in; it then skips the untimed round, too. Smaller: slow cases
  // hold up the others less, and their medians are less reliable.
  int most_rounds = std::numeric_limits<int>::max();
};

// Runs every case once a round: one untimed round, then `rounds` timed ones. Reads the clock right before and
// right after each run. Throws std::invalid_argument for rounds < 1.
//
// Typical usage:
//   const std::vector<Timing> timings = time_interleaved(cases, 7);
//   const double slowdown = ratio(timings[1], timings[0]);
std::vector<Timing> time_interleaved(std::span<const BenchmarkCase> cases, int rounds,
                                     const Clock& clock = wall_clock());
std::vector<Timing> time_interleaved(std::span<const std::function<void()>> cases, int rounds,
                                     const Clock& clock = wall_clock());

// Returns how many times as long the timing takes as the baseline: the median of the ratios in each round that
// both have, because what disturbs a round disturbs both. Throws std::invalid_argument if they have no round in
// common.
double ratio(const Timing& timing, const Timing& baseline);

// Returns the median, of an even count the mean of the two in the middle (base::median_mean). Returns NaN for
// no values.
double median(std::vector<double> values);

}  // namespace vpe::report
