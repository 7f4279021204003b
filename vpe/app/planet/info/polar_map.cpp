#include "vpe/app/planet/info/polar_map.h"

#include <cmath>

namespace vpe::app {

namespace {

double inset_edge() { return std::tan(0.5 * (90 - kPolarLat_deg) * mars::kRadiansPerDegree); }

}  // namespace

std::optional<LitPlace> polar_place(Pole pole, double x, double y) {
  const double distance = std::hypot(x, y);
  if (!(distance <= 1)) return std::nullopt;
  const double lat_deg = 90 - 2 * std::atan(distance * inset_edge()) / mars::kRadiansPerDegree;
  const double down = pole == Pole::kNorth ? y : -y;
  const double lon_deg = distance > 0 ? std::atan2(x, down) / mars::kRadiansPerDegree : 0;
  if (pole == Pole::kNorth) return LitPlace{{lon_deg, lat_deg}, 315 + lon_deg};
  return LitPlace{{lon_deg, -lat_deg}, 315 - lon_deg};
}

glm::dvec2 polar_point(Pole pole, const mars::LonLat& place) {
  const double sign = pole == Pole::kNorth ? 1 : -1;
  const double distance = std::tan(0.5 * (90 - sign * place.lat_deg) * mars::kRadiansPerDegree) / inset_edge();
  const double lon = place.lon_deg * mars::kRadiansPerDegree;
  return {distance * std::sin(lon), sign * distance * std::cos(lon)};
}

}  // namespace vpe::app
