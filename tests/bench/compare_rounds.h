// Compares the times of two pieces of work in alternating rounds, and prints a row of a table.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

namespace bench {

inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

enum class Clock {
  kWall,
  kProcessor,  // of all threads of the process
};

// Prints "| name | median of a, ms | median of b / a in the same round (least..largest) |". The first round loads and does not count.
inline void compare_rounds(const std::string& name, const std::function<void()>& a,
                           const std::function<void()>& b, int rounds, Clock clock = Clock::kWall) {
  const auto now_ms = [clock] {
    if (clock == Clock::kProcessor) return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  const auto once_ms = [&now_ms](const std::function<void()>& work) {
    const double start_ms = now_ms();
    work();
    return now_ms() - start_ms;
  };
  std::vector<double> times;
  std::vector<double> ratios;
  for (int r = 0; r <= rounds; ++r) {
    const double a_ms = once_ms(a);
    const double b_ms = once_ms(b);
    if (r == 0) continue;
    times.push_back(a_ms);
    ratios.push_back(b_ms / a_ms);
  }
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  std::printf("| %s | %.1f | %.2f (%.2f..%.2f) |\n", name.c_str(), median_of(times), median_of(ratios), *low,
              *high);
  std::fflush(stdout);
}

}  // namespace bench
