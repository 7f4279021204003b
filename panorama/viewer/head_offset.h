// Computes where a head is beside a panorama's place.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"

namespace panorama {

// Returns the place in the panorama's frame (east, north, up) of a head that is `head_m` to the right, above and behind
// (x, y, z) of the panorama's place, as seen from a level body that faces the azimuth.
inline glm::dvec3 head_offset(double azimuth_deg, const glm::dvec3& head_m) {
  const double azimuth = std::fmod(azimuth_deg, 360.0) * mars::kRadiansPerDegree;
  const glm::dvec3 right(std::cos(azimuth), -std::sin(azimuth), 0);
  const glm::dvec3 forward(std::sin(azimuth), std::cos(azimuth), 0);
  return right * head_m.x + glm::dvec3(0, 0, head_m.y) - forward * head_m.z;
}

}  // namespace panorama
