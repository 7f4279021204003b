// The discrete column walk of Cohen-Or, Rich, Lerner and Shenkar 1996 (section 2.1 and figure 7), over the posts of a tile.
//
// A column of pixels has a straight path over the map. Of the two axes the path's *major axis* is the one along which it advances
// faster. The walk takes one sample at each grid line across the major axis: the voxel, a post and half a cell about it, that
// holds the path there. Positions are in fixed point, so a step is one addition. Where the ray of the lowest row that is not
// resolved lies on or below the top of the voxel, the row shows the voxel, and so does each next row until one passes above. The
// walk goes on from there: ground that hides nothing of the rows before hides nothing of the later ones.
//
// In contrast to walk_grid() (columns.h) nothing between two grid lines counts. The image has steps of a voxel, and ridges
// narrower than a cell may be missed.
#pragma once

#include <glm/vec3.hpp>

#include "vpe/voxel/columns/columns.h"

namespace vpe::voxel {

// Bits of the fraction of a position in fixed point. A grid has at most kMostDiscreteIntervals cells a side.
inline constexpr int kDiscreteFraction = 20;
inline constexpr int kMostDiscreteIntervals = 512;

// Walks all columns through one height grid and resolves rows, as walk_grid() does, with one sample at each line of the major
// axis. A run of rows that show one voxel has one range, the distance of its top, so Rows::has_ranges must be set. The source is asked for the families
// kColumns and kRows alone. Results are the same to the bit for any instruction set: products and sums are rounded one by one (RowModel may fuse those of slopes).
//
// With blend_from_m > 0 a voxel's height goes over to that of the voxel twice as wide that holds it: its own up to this distance
// from the camera, the wider one's from twice this distance on, and a weighted mean between (section 2, "soft transition").
//
// Requires frame.intervals <= kMostDiscreteIntervals. Heights and distances are in float, so that tops of voxels are off by up
// to 2^-22 of the camera's height above the grid's reference plane.
void walk_grid_discretely(const HeightGridFrame& frame, HeightGridSource& source, const ColumnCamera& camera,
                          const glm::dvec3& up, const Rows& rows, double blend_from_m, ColumnGroup& group);

}  // namespace vpe::voxel
