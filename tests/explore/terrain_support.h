// Terrain without a planet file, for tests of navigation.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

// Hills of +-3 km every few kilometres, cast by small steps: good to a few metres.
inline TerrainQuery hills(double radius_m = mars::kMarsRadius_m) {
  TerrainQuery ground;
  ground.radius_m = radius_m;
  ground.height_m = [](const glm::dvec3& direction) {
    const glm::dvec3 d = glm::normalize(direction) * 900.0;
    return 3000.0 * std::sin(d.x) * std::sin(d.y + 0.3) * std::cos(d.z);
  };
  ground.cast_m = [height_m = ground.height_m, radius_m](const glm::dvec3& camera_m,
                                                         const glm::dvec3& direction) {
    double range_m = 0;
    for (int n = 0; n < 20000; ++n) {
      const glm::dvec3 at = camera_m + direction * range_m;
      const double above_m = glm::length(at) - radius_m - height_m(at);
      if (above_m < 0.5) return range_m;
      if (above_m > 20000.0 && glm::dot(at, direction) > 0.0) break;
      range_m += std::max(0.5, above_m * 0.2);
    }
    return std::numeric_limits<double>::infinity();
  };
  return ground;
}

}  // namespace vpe::explore
