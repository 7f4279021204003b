// The inside of closed shells of voxels.
#pragma once

#include "objects/sticks/voxel_grid.h"

namespace objects {

// Fills all empty voxels of `shells` that no path through sides of empty voxels joins with the outside of the grid.
// Takes time in proportion to the voxels.
void fill_inside(VoxelGrid& shells);

}  // namespace objects
