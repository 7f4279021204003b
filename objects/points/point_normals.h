// Normals of voxels that hold points.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "objects/points/point_voxels.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// Holds what is known of the voxels around points.
struct PointSurroundings {
  const VoxelGrid& held;    // voxels that hold points
  const VoxelGrid& filled;  // and those that close gaps or are enclosed
  int close_voxels = 0;     // half of the widest gap that is closed
};

// Returns a unit normal for each number of `points`: the mean of the points' normals, else that of the plane that fits
// the means of the voxels nearby, turned outward (outward_normals.h). Nearby are the voxels in the smallest cube, of 5
// to 5 + 4 * close_voxels voxels, that has 8 others with points. Where they leave the plane undecided, the normal
// points away from the middle of those nearby, or else up. Takes time in proportion to the grid, and to the voxels with
// points.
std::vector<glm::vec3> point_normals(const PointVoxels& points, const PointSurroundings& around);

}  // namespace objects
