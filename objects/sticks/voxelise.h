// Makes voxels from a mesh.
//
// Typical usage:
//   const StickModel model = build_sticks(voxelise(mesh, textures, {.voxels_longest = 256}));
#pragma once

#include <vector>

#include "objects/model/mesh.h"
#include "objects/model/texture_pyramid.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

struct VoxeliseOptions {
  int voxels_longest = 256;  // along the longest side of the mesh, 1 to 1024
  // Leaves out opaque voxels whose centres lie outside, where there is another one behind. Closed shells then have
  // their volume on the mean, and silhouettes are larger by about half a voxel instead of one.
  bool is_tight = false;
};

// Returns the voxels that triangles pass through, and the inside of closed shells. No voxel that a triangle touches
// is left out, but for triangles without area, for holes (masked or fully transparent places), and by is_tight.
//
// The colour of a voxel is the mean over its triangles, by their areas in it, at the places nearest to its centre. It
// is semi-transparent where only semi-transparent triangles pass through it. The normal is their mean too, or that of
// the largest part where opposite ones cancel out. Inside is what no path through empty or semi-transparent voxels
// joins with the outside; it is opaque. The mesh must pass check(). `textures` are those that its materials name;
// empty: none. Throws std::invalid_argument for options out of range. Takes time in proportion to the triangles and
// the voxels.
VoxelGrid voxelise(const Mesh& mesh, const std::vector<TexturePyramid>& textures,
                   const VoxeliseOptions& options = {});

}  // namespace objects
