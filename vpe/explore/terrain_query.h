// The ground as the eye meets it: S with the exaggeration that is drawn.
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
struct Ground {
  double radius_m = mars::kMarsRadius_m;
  // Metres above the sphere at a direction (any length but 0).
  std::function<double(const glm::dvec3& direction)> height_m;
  // Metres from an eye (from the planet's centre) along a unit direction to the ground; infinity: sky; 0 below
  // it.
  std::function<double(const glm::dvec3& eye_m, const glm::dvec3& direction)> cast_m;
};

// Ground of S; keeps the surface. Tiles that cannot be read count as the sphere.
Ground ground_of(std::shared_ptr<const paging::Surface> surface, double exaggeration);

// A ball without relief.
Ground ball(double radius_m);

}  // namespace vpe::explore
