#include "mars/geodesy/sun.h"

namespace mars {

glm::dvec3 sun_direction(LonLat place, double azimuth_deg, double elevation_deg) {
  const LocalFrame frame = local_frame(place);
  const SinCos azimuth = sin_cos_deg(azimuth_deg);
  const SinCos elevation = sin_cos_deg(elevation_deg);
  return (frame.east * azimuth.sin + frame.north * azimuth.cos) * elevation.cos + frame.up * elevation.sin;
}

}  // namespace mars
