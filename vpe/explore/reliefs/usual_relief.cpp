#include "vpe/explore/reliefs/usual_relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vpe::explore {

using relief::ReliefKind;
using relief::ReliefSpec;

namespace {

constexpr int kCircleCorners = 96;

// Returns the size with two significant digits, within the limits of lengths.
double rounded(double size_m) {
  const double within_m = std::clamp(size_m, relief::kLeastLength_m, relief::kMostLength_m);
  const double step_m = std::pow(10.0, std::floor(std::log10(within_m)) - 1);
  return std::clamp(std::round(within_m / step_m) * step_m, relief::kLeastLength_m, relief::kMostHeight_m);
}

}  // namespace

ReliefSpec usual_relief(ReliefKind kind, mars::LonLat place, double size_m, double azimuth_deg) {
  ReliefSpec relief;
  relief.kind = kind;
  relief.place = place;
  const auto share = [size_m](double part) { return rounded(part * size_m); };
  const auto along = [&] { relief.azimuth_deg = std::round(std::remainder(azimuth_deg, 360.0)); };
  switch (kind) {
    case ReliefKind::kCrater: relief.radius_m = share(0.6); break;
    case ReliefKind::kRamp:
      along();
      relief.length_m = share(1.5);
      relief.width_m = share(0.4);
      relief.end_m = share(0.2);
      break;
    case ReliefKind::kPad:
      relief.radius_m = share(0.7);
      relief.rise_m = share(0.1);
      break;
    case ReliefKind::kTrench:
      along();
      relief.length_m = share(1.5);
      relief.width_m = share(0.2);
      relief.depth_m = share(0.1);
      break;
    case ReliefKind::kDune:
      along();
      relief.height_m = share(0.1);
      break;
    case ReliefKind::kDam:
      along();
      relief.length_m = share(1.5);
      relief.height_m = share(0.2);
      break;
    case ReliefKind::kFlood:
      relief.radius_m = share(0.8);
      relief.rise_m = share(0.02);
      break;
    case ReliefKind::kNoise:
      relief.radius_m = share(0.8);
      relief.amplitude_m = share(0.03);
      relief.wavelength_m = share(0.3);
      break;
  }
  return relief;
}

std::vector<glm::dvec3> relief_outline(const ReliefSpec& relief, double radius_m) {
  std::vector<glm::dvec3> outline;
  if (!relief.polygon.empty()) {
    for (const mars::LonLat corner : relief.polygon) outline.push_back(mars::direction(corner));
    return outline;
  }
  const auto add = [&](double heading_deg, double distance_m) {
    outline.push_back(mars::direction(mars::destination(relief.place, heading_deg, distance_m / radius_m)));
  };
  if (relief.length_m && !relief.radius_m) {
    const double half_x_m = *relief.length_m / 2;
    const double usual_m = relief.kind == ReliefKind::kDam ? relief.height_m.value_or(0) / 4 : *relief.length_m;
    const double half_y_m = relief.width_m.value_or(usual_m) / 2;
    const double aside_deg = std::atan2(half_y_m, half_x_m) * 180 / std::numbers::pi;
    for (const double turn_deg : {aside_deg, 180 - aside_deg, 180 + aside_deg, -aside_deg})
      add(relief.azimuth_deg + turn_deg, std::hypot(half_x_m, half_y_m));
    return outline;
  }
  // The width of a dune that does not say it is about ten times its height.
  const double circle_m =
      relief.radius_m.value_or(relief.width_m.value_or(10 * relief.height_m.value_or(0)) / 2);
  for (int n = 0; n < kCircleCorners; ++n) add(360.0 * n / kCircleCorners, circle_m);
  return outline;
}

}  // namespace vpe::explore
