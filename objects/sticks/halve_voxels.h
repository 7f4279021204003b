// Coarser grids of voxels, for build_sticks.h.
#pragma once

#include "objects/sticks/voxel_grid.h"

namespace objects {

// Returns a tidy grid with voxels of twice the edge. A voxel is opaque if at least 4 of its 8 parts are. Fewer parts,
// and semi-transparent ones, make it semi-transparent: it takes the mean of what rays along its three axes lose. Such
// a voxel that has opaque parts is left out where it has an opaque voxel at a side, so that solids keep a hard
// surface. Colours and normals are means of the coloured parts. Gaps of one voxel between opaque voxels of a column
// are filled. `fine` must be tidy. Pure.
VoxelGrid halved_voxels(const VoxelGrid& fine);

// Removes the colours of opaque voxels that have opaque voxels at all six sides, so that nobody sees them. The grid
// must be tidy, and stays so.
void drop_hidden_colours(VoxelGrid& voxels);

}  // namespace objects
