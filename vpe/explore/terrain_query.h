// The terrain as navigation uses it: the reference surface with the exaggeration that is drawn.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"

namespace vpe::explore {

// Holds the two queries of navigation. They do not depend on what is drawn or loaded. Any thread may call them
// if the objects that they refer to allow it.
struct TerrainQuery {
  double radius_m = mars::kMarsRadius_m;
  double highest_radii = 10;  // highest altitude of a camera above the sphere; SteerLimits::kHighest_radii
  // Returns the height above the sphere at a direction (of any length but 0), metres.
  std::function<double(const glm::dvec3& direction)> height_m;
  // Returns the distance from a camera (relative to the planet's centre) along a unit direction to the ground,
  // metres; infinity for the sky; 0 if the camera is below the ground.
  std::function<double(const glm::dvec3& camera_m, const glm::dvec3& direction)> cast_m;
};

// Queries the reference surface, which is kept alive. Tiles that cannot be read count as the sphere.
TerrainQuery ground_of(std::shared_ptr<const paging::Surface> surface, double exaggeration);

// Queries a sphere without terrain.
TerrainQuery ball(double radius_m);

}  // namespace vpe::explore
