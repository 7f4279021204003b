// Makes voxels from a point cloud.
//
// Typical usage:
//   const ModelFile cloud = read_model_file("rock.ply", {.allows_points = true});
//   const StickModel model = build_sticks(voxelise_points(cloud.mesh, {.voxels_longest = 512}));
#pragma once

#include "objects/model/mesh.h"
#include "objects/points/close_gaps.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

struct VoxelisePointsOptions {
  int voxels_longest = 256;  // along the longest side of the points, 1 to kMostVoxelsLongest (grid_around.h)
  int close_voxels = 1;      // closes gaps between points of up to twice so many voxels, 0 to kMostCloseVoxels
};

// Returns the voxels that hold points, those that close gaps between them, and what both enclose (close_gaps.h). With
// close_voxels 0 gaps stay, and only what voxels with points enclose is added.
//
// The colour of a voxel is the mean of its points' colours, grey (160) without colours; all voxels are opaque. Its
// normal is the mean of their normals, or else that of a plane through the points nearby (point_normals.h). Voxels that
// close gaps look like the nearest ones with points (gap_looks.h). The order of points has no effect. `points` must
// pass check_points(). Throws std::invalid_argument if it does not, for options out of range, and for points that all
// lie in one place.
VoxelGrid voxelise_points(const Mesh& points, const VoxelisePointsOptions& options = {});

}  // namespace objects
