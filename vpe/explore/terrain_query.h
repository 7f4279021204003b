// The ground as the camera meets it: S with the exaggeration that is drawn.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace vpe::explore {

// Two questions that moving asks. Neither depends on what is drawn or loaded. Both may be called from any
// thread when what they were made of may.
struct TerrainQuery {
  double radius_m = mars::kMarsRadius_m;
  // Metres above the sphere at a direction (any length but 0).
  std::function<double(const glm::dvec3& direction)> height_m;
  // Metres from a camera (from the planet's centre) along a unit direction to the ground; infinity: sky; 0 below
  // it.
  std::function<double(const glm::dvec3& camera_m, const glm::dvec3& direction)> cast_m;
};

// Ground of S; keeps the surface. Tiles that cannot be read count as the sphere.
TerrainQuery ground_of(std::shared_ptr<const paging::Surface> surface, double exaggeration);

// A ball without relief.
TerrainQuery ball(double radius_m);

}  // namespace vpe::explore
