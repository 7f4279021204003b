// The plane on which feet or wheels stand.
//
// Typical usage:
//   const ContactPlane plane = wheel_plane(level, 2.9, 2.3, ground);  // of a rover
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"

namespace objects {

struct ContactPlane {
  mars::LocalFrame frame;        // up: the plane's normal; north: forward; east: to the right
  glm::dvec3 origin_m{0, 0, 0};  // on the plane, and on the vertical of the place
};

// Returns the plane that fits best, in height, to the ground at the verticals of four feet. `level` has up at
// the place and north ahead, `place_m` is a point of the place's vertical. Seen from above, forward stays where
// it was. Feet on one vertical give the level plane.
ContactPlane contact_plane(const mars::LocalFrame& level, const glm::dvec3& place_m,
                           const std::array<glm::dvec3, 4>& feet_m,
                           const std::function<double(const glm::dvec3& direction)>& ground_radius_m);

// Returns the plane that fits best to the ground under four wheels around the place, lifted until none is below the
// ground.
ContactPlane wheel_plane(const mars::LocalFrame& level, double wheelbase_m, double track_m,
                         const std::function<double(const glm::dvec3& direction)>& ground_radius_m);

}  // namespace objects
