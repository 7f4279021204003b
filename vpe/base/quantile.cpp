#include "vpe/base/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vpe::base {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double element(std::span<double> values, std::size_t index) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Returns share * (count - 1), within 0 and count - 1.
double rank(std::size_t count, double share) {
  return std::clamp(share, 0.0, 1.0) * static_cast<double>(count - 1);
}

}  // namespace

double median_upper(std::span<double> values) {
  return values.empty() ? kNaN : element(values, values.size() / 2);
}

double median_mean(std::span<double> values) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double quantile_floor(std::span<double> values, double share) {
  if (values.empty()) return kNaN;
  return element(values, static_cast<std::size_t>(rank(values.size(), share)));
}

double quantile_round(std::span<double> values, double share) {
  if (values.empty()) return kNaN;
  return element(values, static_cast<std::size_t>(std::lround(rank(values.size(), share))));
}

double sorted_quantile_rank(std::span<const double> sorted, double share) {
  if (sorted.empty()) return kNaN;
  const double last = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(last, 1.0)) - 1];
}

}  // namespace vpe::base
