#include "vpe/explore/terrain_query.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "paging/planet/planet_file.h"

namespace vpe::explore {

namespace {

double cast_ball(const glm::dvec3& camera_m, const glm::dvec3& direction, double radius_m) {
  const double middle_m = -glm::dot(camera_m, direction);
  const glm::dvec3 nearest = camera_m + direction * middle_m;
  const double half2 = (radius_m - glm::length(nearest)) * (radius_m + glm::length(nearest));
  if (glm::length(camera_m) <= radius_m) return 0.0;
  if (middle_m <= 0.0 || half2 < 0.0) return std::numeric_limits<double>::infinity();
  return middle_m - std::sqrt(half2);
}

}  // namespace

TerrainQuery ground_of(std::shared_ptr<const paging::Surface> surface, double exaggeration) {
  TerrainQuery ground;
  ground.radius_m = surface->planet_radius_m();
  ground.height_m = [surface, exaggeration](const glm::dvec3& direction) {
    try {
      return surface->at(direction, exaggeration).height_m;
    } catch (const paging::PlanetError&) {
      return 0.0;
    }
  };
  ground.cast_m = [surface, exaggeration](const glm::dvec3& camera_m, const glm::dvec3& direction) {
    try {
      return surface->cast(camera_m, direction, exaggeration);
    } catch (const paging::PlanetError&) {
      return cast_ball(camera_m, direction, surface->planet_radius_m());
    }
  };
  return ground;
}

TerrainQuery ball(double radius_m) {
  TerrainQuery ground;
  ground.radius_m = radius_m;
  ground.height_m = [](const glm::dvec3&) { return 0.0; };
  ground.cast_m = [radius_m](const glm::dvec3& camera_m, const glm::dvec3& direction) {
    return cast_ball(camera_m, direction, radius_m);
  };
  return ground;
}

}  // namespace vpe::explore
