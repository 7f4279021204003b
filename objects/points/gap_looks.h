// Colours and normals of voxels that close gaps between points.
#pragma once

#include <vector>

#include "objects/points/point_voxels.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// Gives each voxel of `out` that is not in `held`, and has a side at which `out` is empty, the mean look of the nearest
// voxels of `held`: those at the least distance, by the largest of the three differences, up to `most_reach`. `looks`
// belongs to the numbers of `points`. Takes time in proportion to the grid, and to the gaps times the square of their
// widths.
void colour_gaps(const PointVoxels& points, const std::vector<StickVoxel>& looks, const VoxelGrid& held,
                 int most_reach, VoxelGrid& out);

}  // namespace objects
