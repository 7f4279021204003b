// The share of a cube that lies below a plane.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::voxel {

// Returns the share, 0 to 1, of the unit cube about the origin where dot(normal, x) <= distance. The normal is a unit vector;
// the error is at most 1e-4, where the plane is turned by that to keep divisors from 0. Pure.
double cube_share_below(const glm::dvec3& normal, double distance);

}  // namespace vpe::voxel
