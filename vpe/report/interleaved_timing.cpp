#include "vpe/report/interleaved_timing.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>

#include "vpe/base/quantile.h"

namespace vpe::report {

Clock wall_clock() {
  return
      [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
}

double median(std::vector<double> values) { return base::median_mean(values); }

double Timing::median_s() const { return median(round_s); }

std::vector<Timing> time_interleaved(std::span<const BenchmarkCase> cases, int rounds, const Clock& clock) {
  if (rounds < 1) throw std::invalid_argument("time_interleaved: at least one round is needed");
  std::vector<Timing> timings(cases.size());
  std::vector<double> last_s(cases.size(), std::numeric_limits<double>::quiet_NaN());
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const BenchmarkCase& benchmark_case = cases[k];
      const bool is_limited = benchmark_case.most_rounds < rounds;
      if (is_limited && (round < 0 || round >= benchmark_case.most_rounds)) continue;
      if (benchmark_case.prepare) benchmark_case.prepare(last_s[k]);
      const double begin_s = clock();
      benchmark_case.run();
      const double end_s = clock();
      last_s[k] = end_s - begin_s;
      if (round >= 0) timings[k].round_s.push_back(end_s - begin_s);
    }
  }
  return timings;
}

std::vector<Timing> time_interleaved(std::span<const std::function<void()>> cases, int rounds,
                                     const Clock& clock) {
  std::vector<BenchmarkCase> all;
  for (const std::function<void()>& run : cases) all.push_back({run, {}});
  return time_interleaved(all, rounds, clock);
}

double ratio(const Timing& timing, const Timing& baseline) {
  const std::size_t rounds = std::min(timing.round_s.size(), baseline.round_s.size());
  if (rounds == 0) throw std::invalid_argument("ratio: one of the two was not timed");
  std::vector<double> ratios;
  for (std::size_t k = 0; k < rounds; ++k) ratios.push_back(timing.round_s[k] / baseline.round_s[k]);
  return median(std::move(ratios));
}

}  // namespace vpe::report
