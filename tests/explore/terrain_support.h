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

// Ground that is rough for feet and wheels: bumps of metres, slopes up to cliffs, and steps of 3 m. Rays see a ball.
inline TerrainQuery rough_ground(double radius_m = mars::kMarsRadius_m) {
  TerrainQuery ground = ball(radius_m);
  ground.height_m = [radius_m](const glm::dvec3& direction) {
    const glm::dvec3 at_m = glm::normalize(direction) * radius_m;
    const double hills_m = 40.0 * std::sin(at_m.x / 90.0) * std::sin(at_m.y / 70.0);
    const double bumps_m = 1.5 * std::sin(at_m.x / 4.0 + 1.0) * std::cos(at_m.y / 3.0) * std::sin(at_m.z / 5.0);
    const double step_m = 3.0 * std::floor(std::sin(at_m.y / 30.0) + std::cos(at_m.z / 25.0));
    return hills_m + bumps_m + step_m;
  };
  return ground;
}

// A plane through longitude and latitude 0 with slopes (rise over run) to the east and the north.
inline TerrainQuery sloping_ground(double east, double north, double radius_m = mars::kMarsRadius_m) {
  TerrainQuery ground = ball(radius_m);
  ground.height_m = [=](const glm::dvec3& direction) {
    const mars::LonLat at = mars::lon_lat(direction);
    return radius_m * mars::kRadiansPerDegree * (east * at.lon_deg + north * at.lat_deg);
  };
  return ground;
}

}  // namespace vpe::explore
