// Direction of the sun in the body-fixed frame, and its position in the sky of a place.
#pragma once

#include "mars/geodesy/sphere.h"

namespace mars {

// Describes the position of the sun in the sky of a place.
struct SunPosition {
  double azimuth_deg = 0;    // clockwise from north, [0, 360); 0 with the sun in the zenith or nadir
  double elevation_deg = 0;  // above the local horizontal
};

// Returns the unit direction of a sun that stands at `azimuth_deg` (clockwise from north) and `elevation_deg`
// above the local horizontal of a place. The sun is taken to be infinitely far: the whole planet has one
// direction.
glm::dvec3 sun_direction(LonLat place, double azimuth_deg, double elevation_deg);

// Returns the position of a sun of this unit direction in the sky of a place. Inverse of sun_direction().
SunPosition sun_position(LonLat place, const glm::dvec3& direction);

}  // namespace mars
