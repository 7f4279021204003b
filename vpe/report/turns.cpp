#include "vpe/report/turns.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>

namespace vpe::report {

Clock wall_clock() {
  return
      [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double Timing::median_s() const { return median(round_s); }

std::vector<Timing> time_in_turns(std::span<const std::function<void()>> contestants, int rounds,
                                  const Clock& clock) {
  if (rounds < 1) throw std::invalid_argument("time_in_turns: at least one round");
  std::vector<Timing> timings(contestants.size());
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t k = 0; k < contestants.size(); ++k) {
      const double begin_s = clock();
      contestants[k]();
      const double end_s = clock();
      if (round >= 0) timings[k].round_s.push_back(end_s - begin_s);
    }
  }
  return timings;
}

double ratio(const Timing& timing, const Timing& baseline) {
  if (timing.round_s.size() != baseline.round_s.size()) {
    throw std::invalid_argument("ratio: the rounds of both must be the same");
  }
  std::vector<double> ratios;
  for (std::size_t k = 0; k < timing.round_s.size(); ++k)
    ratios.push_back(timing.round_s[k] / baseline.round_s[k]);
  return median(std::move(ratios));
}

}  // namespace vpe::report
