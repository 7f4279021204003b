#include "panorama/match/skyline_profile.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace panorama {

SkylineProfile::SkylineProfile(std::vector<double> elevations_deg)
    : elevations_deg_(std::move(elevations_deg)),
      step_deg_(360.0 / static_cast<double>(std::max<std::size_t>(1, elevations_deg_.size()))) {
  if (elevations_deg_.size() < kLeastSamples)
    throw std::invalid_argument("the profile of a skyline needs at least 8 elevations");
  if (!std::all_of(elevations_deg_.begin(), elevations_deg_.end(), [](double e) { return std::isfinite(e); }))
    throw std::invalid_argument("an elevation of the skyline is not finite");
}

double SkylineProfile::elevation_deg(double azimuth_deg) const {
  const double turn = azimuth_deg / 360.0;
  const double at = (turn - std::floor(turn)) * static_cast<double>(elevations_deg_.size());
  const auto n = std::min(static_cast<std::size_t>(at), elevations_deg_.size() - 1);
  const double t = at - static_cast<double>(n);
  const std::size_t next = n + 1 == elevations_deg_.size() ? 0 : n + 1;
  return elevations_deg_[n] * (1 - t) + elevations_deg_[next] * t;
}

double SkylineProfile::slope(double azimuth_deg, double half_width_deg) const {
  return (elevation_deg(azimuth_deg + half_width_deg) - elevation_deg(azimuth_deg - half_width_deg)) /
         (2 * half_width_deg);
}

std::vector<double> SkylineProfile::azimuths_deg(std::size_t samples) {
  std::vector<double> out(samples);
  for (std::size_t n = 0; n < samples; ++n)
    out[n] = 360.0 * static_cast<double>(n) / static_cast<double>(samples);
  return out;
}

}  // namespace panorama
