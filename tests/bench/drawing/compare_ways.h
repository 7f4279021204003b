// Compares two ways to do the same work by processor time, in alternating rounds.
#pragma once

#include <algorithm>
#include <ctime>
#include <functional>
#include <vector>

#include "tests/bench/compare_rounds.h"

namespace bench {

// Gives processor times of all threads, and the ratio of both in the same round.
struct WayTimes {
  double former_ms = 0;  // median
  double now_ms = 0;     // median
  double ratio = 0;      // now / former, median
  double least = 0;
  double most = 0;
};

// Does both ways once in each round. The first round loads and does not count. `prepare` runs before each, and is not timed.
inline WayTimes compare_ways(
    const std::function<void()>& former, const std::function<void()>& now, int rounds,
    const std::function<void()>& prepare = [] {}) {
  const auto once_ms = [&](const std::function<void()>& work) {
    prepare();
    const std::clock_t start = std::clock();
    work();
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  std::vector<double> a_ms, b_ms, ratios;
  for (int round = 0; round <= rounds; ++round) {
    const double a = once_ms(former);
    const double b = once_ms(now);
    if (round == 0) continue;
    a_ms.push_back(a);
    b_ms.push_back(b);
    ratios.push_back(b / a);
  }
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  return {median_of(a_ms), median_of(b_ms), median_of(ratios), *least, *most};
}

}  // namespace bench
