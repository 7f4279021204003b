// Gaps in surfaces of voxels, and what surfaces enclose.
#pragma once

#include "objects/sticks/voxel_grid.h"

namespace objects {

inline constexpr int kMostCloseVoxels = 16;

// Fills gaps of up to twice `reach` voxels, 0 to kMostCloseVoxels, and what is enclosed: the voxels within `reach` of
// a filled one, the largest of the three differences counting, are filled (dilation); then what they enclose
// (fill_inside()); then all within `reach` of an empty voxel are emptied again (erosion), on a grid that goes on without
// end. So shells have an inside even if no gap in them is closed to the last voxel, as in slanted ones. The closing by a
// cube (Serra 1982) and its inside are parts of the result. No voxel is removed; each that is filled is within `reach`
// of one, or enclosed by such voxels; a second call with the same reach changes nothing. With 0 this is fill_inside().
// Takes time and memory in proportion to the grid with `reach` more voxels at each side.
void close_gaps(VoxelGrid& voxels, int reach);

}  // namespace objects
