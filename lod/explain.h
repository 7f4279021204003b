// Why every drawn tile has its level: select()'s reasons, worked out again from its result. Pure.
#pragma once

#include <vector>

#include "lod/select.h"

namespace lod {

enum class LevelReason {
  kFinestThere,      // its full grid is drawn: nothing finer is there
  kWithinTolerance,  // rule error: its error, shifted by control, is within the tolerance
  kLevelReached,     // rule hitchner: its number is the LOD wanted, or above it
  kBudgetSpent,      // the triangles were spent before it could be refined
};
const char* to_string(
    LevelReason reason);  // "finest there", "within tolerance", "level reached", "budget spent"

struct TileExplanation {
  TileKey key;
  int lod = 1;                // the number of 1992: 1 = coarsest
  double post_spacing_m = 0;  // of the posts that its mesh is chosen from, at nominal size
  int variant = 0;            // 0 = the coarsest mesh of the tile
  int variants = 1;
  double min_distance_m = 0;     // lower bound, to the tile with the mesh that is drawn
  double geometric_error_m = 0;  // bounds, of the mesh that is drawn
  double screen_space_error_px = 0;
  ControlTerms terms;  // taken with the coarsest mesh, as in select()
  double shift = 0;    // rule error: levels that the error counted more
  int wanted = 0;      // rule hitchner: the LOD number wanted
  LevelReason reason = LevelReason::kWithinTolerance;
};

// One for every tile of the selection, in its order; the first three arguments are those that it was made with.
// The terms have their x also where the weight is 0.
std::vector<TileExplanation> explain(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                                     const Selection& selection);

}  // namespace lod
