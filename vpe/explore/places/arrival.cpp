#include "vpe/explore/places/arrival.h"

#include <algorithm>
#include <cmath>

#include "vpe/explore/steer.h"

namespace vpe::explore {

mars::Pose arrival(const core::Place& place, const Screen& screen, const TerrainQuery& ground) {
  using L = ArrivalLimits;
  const double diameter_m = place.diameter_m > 0 ? place.diameter_m : L::kUnknown_m;
  const double share =
      std::clamp(std::log(diameter_m / L::kTilted_m) / std::log(L::kFromAbove_m / L::kTilted_m), 0.0, 1.0);
  const double shorter_px = std::min(screen.width, screen.height);
  const double half_tan =
      std::tan(screen.fov_deg / 2 * mars::kRadiansPerDegree) * shorter_px / std::max(screen.height, 1);
  // Half of the place is seen at this angle. A large one curves away: what is left of it lies deeper.
  const double half_arc_rad = std::min(diameter_m / 2 / ground.radius_m, mars::kPi / 3);
  const double sink_m = ground.radius_m * (1 - std::cos(half_arc_rad));
  const double distance_m = ground.radius_m * std::sin(half_arc_rad) / (L::kFill * half_tan) - sink_m;
  const glm::dvec3 up = mars::direction({place.lon_deg, place.lat_deg});
  const glm::dvec3 point_m = up * (ground.radius_m + ground.height_m(up));
  mars::Pose from{place.lon_deg, place.lat_deg, 0, 0, L::kTilt_deg + (-90 - L::kTilt_deg) * share, 0};
  from.alt_m = ground.height_m(up) + distance_m;
  return looking_at(from, point_m, std::max(distance_m, MouseLimits::kNearest_m), ground);
}

}  // namespace vpe::explore
