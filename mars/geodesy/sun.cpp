#include "mars/geodesy/sun.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace mars {

glm::dvec3 sun_direction(LonLat place, double azimuth_deg, double elevation_deg) {
  const LocalFrame frame = local_frame(place);
  const SinCos azimuth = sin_cos_deg(azimuth_deg);
  const SinCos elevation = sin_cos_deg(elevation_deg);
  return (frame.east * azimuth.sin + frame.north * azimuth.cos) * elevation.cos + frame.up * elevation.sin;
}

SunPosition sun_position(LonLat place, const glm::dvec3& direction) {
  const LocalFrame frame = local_frame(place);
  const double east = glm::dot(direction, frame.east);
  const double north = glm::dot(direction, frame.north);
  const double up = glm::dot(direction, frame.up);
  SunPosition position;
  position.elevation_deg = std::atan2(up, std::hypot(east, north)) / kRadiansPerDegree;
  if (east == 0 && north == 0) return position;
  const double azimuth_deg = std::atan2(east, north) / kRadiansPerDegree;
  position.azimuth_deg = azimuth_deg - 360 * std::floor(azimuth_deg / 360);
  if (position.azimuth_deg >= 360) position.azimuth_deg = 0;  // rounding of a small negative angle
  return position;
}

}  // namespace mars
