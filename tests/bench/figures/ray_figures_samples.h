// Samples beside the pixels of a perspective image, and their refinement, taken apart: what SectorCaster does, with
// the results of each stage.
#pragma once

#include <vector>

#include "tests/bench/figures/ray_figures.h"
#include "vpe/voxel/columns/view_sector.h"

namespace bench {

// Holds one pixel with the two samples of its row that it lies between.
struct HintedPixel {
  int x = 0;
  int y = 0;
  double hint_m[2] = {0, 0};  // ranges of the samples on the left and on the right
  glm::dvec2 sample[2];       // image positions of the samples
  double share = 0;           // of the way from the left one to the right one
  bool refined = false;       // found from the hints, without a single cast
  double range_m = 0;         // in the finished image
  double near_m() const { return hint_m[0] < hint_m[1] ? hint_m[0] : hint_m[1]; }
};
inline constexpr double kApart = 0.04;  // as in refine_kernel.cpp and sector_caster.cpp

// Returns the pixels of the sector above V, those whose hints are finite, row by row.
std::vector<HintedPixel> hinted_pixels(const Scene& scene, const vpe::core::View& view);

}  // namespace bench
