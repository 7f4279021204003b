#include "objects/scene/rock_sizes.h"

#include <algorithm>
#include <cmath>

namespace objects {

namespace {

constexpr std::size_t kSizeSteps = 8192;

// Returns the rocks on a square metre, for each unit of the logarithm of diameter: D n(D) with
// n = -dF/dD / (pi D^2 / 4).
double rocks_of_log(double k, double diameter_m) {
  const double q = 1.79 + 0.152 / k;
  return k * q * std::exp(-q * diameter_m) / (0.25 * mars::kPi * diameter_m);
}

}  // namespace

RockSizes::RockSizes(const ScatterEntry& entry)
    : least_m_(entry.least_diameter_m), log_ratio_(std::log(entry.most_diameter_m / entry.least_diameter_m)) {
  if (const auto* law = std::get_if<PowerLaw>(&entry.distribution)) {
    rocks_per_m2_ = law->density_per_m2;
    exponent_ = law->exponent;
    return;
  }
  const double k = std::get<RockAbundance>(entry.distribution).k;
  const double step = log_ratio_ / static_cast<double>(kSizeSteps);
  const auto density = [&](double n) { return rocks_of_log(k, least_m_ * std::exp(n * step)); };
  shares_.assign(kSizeSteps + 1, 0);
  for (std::size_t n = 0; n < kSizeSteps; ++n) {
    const auto at = static_cast<double>(n);
    const double simpson = (density(at) + 4 * density(at + 0.5) + density(at + 1)) / 6;
    shares_[n + 1] = shares_[n] + step * simpson;
  }
  rocks_per_m2_ = shares_.back();
  if (rocks_per_m2_ > 0) {
    for (double& share : shares_) share /= rocks_per_m2_;
  }
}

double RockSizes::diameter_m(double share) const {
  double log_diameter = 0;  // in units of the whole range
  if (!shares_.empty()) {
    if (!(rocks_per_m2_ > 0)) return least_m_;
    const auto above = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, share);
    const double below = *(above - 1);
    const double width = *above - below;
    const double part = width > 0 ? std::clamp((share - below) / width, 0.0, 1.0) : 0;
    log_diameter = (static_cast<double>(above - 1 - shares_.begin()) + part) / static_cast<double>(kSizeSteps);
  } else if (exponent_ * log_ratio_ < 1e-9) {
    log_diameter = share;
  } else {
    const double whole = std::expm1(-exponent_ * log_ratio_);
    log_diameter = std::min(1.0, -std::log1p(share * whole) / (exponent_ * log_ratio_));
  }
  return least_m_ * std::exp(log_diameter * log_ratio_);
}

}  // namespace objects
