#include "vpe/base/nice_ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace vpe::base {

namespace {

constexpr std::array<double, 3> kFactors{1, 2, 5};
// Beyond these limits powers of ten are not normal doubles.
constexpr double kLeastStep = 1e-300;
constexpr double kLargestRange = 1e300;

bool has_step(double x) { return x > 0 && std::isfinite(x); }

int exponent_of(double x, double slack) { return static_cast<int>(std::floor(std::log10(x) + slack)); }

bool has_ticks(double low, double high, int most) {
  if (most < 1 || !std::isfinite(low) || !std::isfinite(high)) return false;
  const double range = high - low;
  return range <= kLargestRange && range / most >= kLeastStep;
}

}  // namespace

double power_of_ten(int exponent) {
  // Powers up to 1e22 are exact, so that their reciprocals are rounded once.
  constexpr int kExact = 22;
  if (exponent < 0 && exponent >= -kExact) return 1.0 / std::pow(10.0, -exponent);
  return std::pow(10.0, exponent);
}

double nice_step_below(double x) {
  if (!has_step(x)) return x;
  const double unit = power_of_ten(exponent_of(x, kNiceSlack));
  double best = unit;
  for (const double step : {2 * unit, 5 * unit, 10 * unit}) {
    if (step <= x * (1 + kNiceSlack)) best = step;
  }
  return best;
}

double nice_step_above(double x, double slack) {
  if (!has_step(x)) return x;
  const double unit = power_of_ten(exponent_of(x, slack));
  for (const double factor : kFactors) {
    if (factor * unit >= x * (1 - slack)) return factor * unit;
  }
  return 10 * unit;
}

int step_decimals(double step) {
  constexpr int kMost = 9;
  for (int n = 0; n < kMost; ++n) {
    const double scaled = step * power_of_ten(n);
    if (std::abs(scaled - std::round(scaled)) <= 1e-6 * scaled) return n;
  }
  return kMost;
}

NiceTicks nice_ticks(double low, double high, int most) {
  NiceTicks ticks;
  if (most < 2 || !has_ticks(low, high, most)) return ticks;
  const int least = exponent_of((high - low) / most, 0);
  const double room = (high - low) * kNiceSlack;
  for (int n = 0;; ++n) {
    const int exponent = least + n / 3;
    const double step = kFactors[static_cast<std::size_t>(n % 3)] * power_of_ten(exponent);
    const double first = std::ceil((low - room) / step);
    const double last = std::floor((high + room) / step);
    if (last - first >= most) continue;
    ticks.decimals = std::max(0, -exponent);
    const int count = static_cast<int>(last - first) + 1;
    double multiple = first;  // counted separately: adding 1 to a large one may not change it
    for (int k = 0; k < count; ++k, ++multiple) ticks.values.push_back(multiple * step);
    return ticks;
  }
}

std::vector<double> nice_ticks_two_or_more(double low, double high, int most) {
  std::vector<double> values;
  if (!has_ticks(low, high, most)) return values;
  const double range = high - low;
  for (double step = nice_step_above(range / most);; step = nice_step_below(step * 0.6)) {
    const double begin = std::ceil(low / step - kNiceSlack);
    const double end = std::floor(high / step + kNiceSlack);
    // A range of a few bits has no multiples that can be told apart.
    constexpr double kCountable = 4e18;
    if (std::max(-begin, end) > kCountable) return values;
    const auto first = static_cast<std::int64_t>(begin);
    const auto last = static_cast<std::int64_t>(end);
    if (last > first || step < range * 1e-3) {
      for (std::int64_t k = first; k <= last; ++k) values.push_back(static_cast<double>(k) * step);
      return values;
    }
  }
}

}  // namespace vpe::base
