// Compares ranges of the ray backend with what RangeCaster states about them.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/surface/surface.h"

namespace test_support {

// Describes the ray of a pixel that is compared.
struct CastRay {
  glm::dvec3 camera_m;
  glm::dvec3 direction;  // unit
  double exaggeration = 1;
};

// Returns the error of a range times the sine of incidence on the facet that is met, of the range: what
// RangeCaster::range_error() bounds. Requires finite ranges.
inline double stated_range_error(const paging::Surface& surface, const CastRay& ray, double seen_m,
                                 double exact_m) {
  const glm::dvec3 normal = surface.at(ray.camera_m + exact_m * ray.direction, ray.exaggeration).normal;
  return std::abs(glm::dot(normal, ray.direction)) * std::abs(seen_m - exact_m) / exact_m;
}

// Returns true if a slightly tilted ray meets the surface where the pixel saw it: the ray only just touches
// something, or misses it.
inline bool is_tie(const paging::Surface& surface, const CastRay& ray, double seen_m, double tilt_rad) {
  const glm::dvec3 up = glm::normalize(ray.camera_m);
  const glm::dvec3 side = glm::normalize(glm::cross(ray.direction, up));
  const glm::dvec3 over = glm::cross(side, ray.direction);
  for (int n = 0; n < 24; ++n) {
    const double angle_rad = 0.785398 * n;
    const double size = tilt_rad * (n / 8 + 1) / 3;
    const glm::dvec3 beside =
        glm::normalize(ray.direction + size * (std::cos(angle_rad) * side + std::sin(angle_rad) * over));
    const double other_m = surface.cast(ray.camera_m, beside, ray.exaggeration);
    if (std::isinf(seen_m) ? std::isinf(other_m) : std::abs(other_m - seen_m) <= 1e-3 * seen_m) return true;
  }
  return false;
}

}  // namespace test_support
