// Divides the rows of one side of V into rings, so that lines are not crowded near V.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): SectorPlan makes a sector of each ring.
#pragma once

#include <span>
#include <vector>

namespace vpe::voxel {

// Describes a row (or column) of pixels of a side: its distance from V, and the lines through V beside its pixels, by their
// offset across for each pixel away from V. Without pixels, low is above high.
struct RingRow {
  double distance_px = 0;
  double low = 0;
  double high = 0;
};

// Returns where rings end, the last at rows.size() > 0, of rows ordered from the farthest from V to the nearest. The first row of a
// ring says how far apart its lines are. Their samples, with 60 more for each line, are the fewest that at most `most_rings` >= 1
// rings can have which begin at sixteenths of the rows; a ring that saves less than a twentieth is left out.
std::vector<int> ring_ends(std::span<const RingRow> rows, int most_rings);

}  // namespace vpe::voxel
