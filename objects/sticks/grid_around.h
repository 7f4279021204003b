// The grid of voxels around a shape.
#pragma once

#include <glm/vec3.hpp>

#include "objects/sticks/stick_model.h"

namespace objects {

inline constexpr int kMostVoxelsLongest = 1024;

// Returns the grid, with so many voxels along its longest side, around what lies between two corners. It is a little
// larger, so that what lies on its sides lies in voxels and not between two. voxels_longest must be 1 to
// kMostVoxelsLongest. Pure.
StickGrid grid_around(const glm::dvec3& low_m, const glm::dvec3& high_m, int voxels_longest);

}  // namespace objects
