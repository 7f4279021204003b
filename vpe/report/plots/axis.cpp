#include "vpe/report/plots/axis.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/nice_ticks.h"
#include "vpe/base/number.h"

namespace vpe::report {
namespace {

constexpr int kMostTicks = 8;

}  // namespace

Axis::Axis(const std::vector<double>& values, bool logarithmic) : logarithmic_(logarithmic) {
  bool any = false;
  double low = 0;
  double high = 0;
  for (const double value : values) {
    if (!std::isfinite(value) || below(value)) continue;
    low = any ? std::min(low, value) : value;
    high = any ? std::max(high, value) : value;
    any = true;
  }
  if (!any) {
    low = 1;
    high = 10;
  }
  if (logarithmic_) {
    low_ = std::floor(std::log10(low) + 1e-9);
    high_ = std::max(std::ceil(std::log10(high) - 1e-9), low_ + 1);
    step_ = std::ceil((high_ - low_) / kMostTicks);
    return;
  }
  if (high == low) {
    low -= low == 0 ? 1 : std::abs(low) / 2;
    high += high == 0 ? 1 : std::abs(high) / 2;
  }
  step_ = base::nice_step_above((high - low) / (kMostTicks - 2), 0);
  low_ = std::floor(low / step_ + 1e-9) * step_;
  high_ = std::ceil(high / step_ - 1e-9) * step_;
}

double Axis::place(double value) const {
  if (below(value)) return 0;
  return ((logarithmic_ ? std::log10(value) : value) - low_) / (high_ - low_);
}

std::vector<Tick> Axis::ticks() const {
  std::vector<Tick> ticks;
  const int count = static_cast<int>(std::floor((high_ - low_) / step_ + 1e-6));
  for (int k = 0; k <= count; ++k) {
    const double at = low_ + k * step_;
    if (!logarithmic_) {
      // Rounds the product of multiple and step: 0.30000000000000004 becomes 0.3.
      const double value = std::round(at / step_) * step_;
      ticks.push_back({value, base::format_rounded(value, 12)});
      continue;
    }
    const int decade = static_cast<int>(at);
    const double value = std::pow(10.0, decade);
    ticks.push_back(
        {value, decade >= -3 && decade <= 4 ? base::format_number(value) : "1e" + std::to_string(decade)});
  }
  return ticks;
}

}  // namespace vpe::report
