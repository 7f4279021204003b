// Direction of the sun, body-fixed.
#pragma once

#include "mars/geodesy/sphere.h"

namespace mars {

// Unit direction towards a sun that stands at `azimuth_deg` (clockwise from north) and `elevation_deg` above the
// horizontal of a place. The sun is at infinity: one direction for the whole planet.
glm::dvec3 sun_direction(LonLat place, double azimuth_deg, double elevation_deg);

}  // namespace mars
