// Explains why every drawn tile has its level: computes the reasons of select() again from its result. Pure.
//
// Typical usage:
//   select(options, tree, view, scratch, selection);
//   for (const TileExplanation& e : explain(options, tree, view, selection)) {
//     print(to_string(e.key), e.screen_space_error_px, to_string(e.reason));
//   }
#pragma once

#include <vector>

#include "lod/select.h"

namespace lod {

enum class LevelReason {
  kFinestThere,      // its full grid is drawn; the planet file has nothing finer
  kWithinTolerance,  // metric kError: its error, shifted by control, is within the tolerance
  kLevelReached,     // metric kDistance: it has the wanted level or a finer one
  kBudgetSpent,      // the triangles were spent before it could be refined
  kReplaced,         // by rays: an ancestor is cast in its place, as the tile is not there
};

// Returns "finest there", "within tolerance", "level reached", "budget spent" or "replaced by an ancestor".
const char* to_string(LevelReason reason);

// Explains one tile.
struct TileExplanation {
  TileKey key;                // with its level, which counts from 0
  double post_spacing_m = 0;  // nominal spacing of the posts from which its mesh is chosen
  int variant = 0;            // 0 = the coarsest mesh of the tile
  int variants = 1;
  double min_distance_m = 0;         // lower bound of the distance to the tile with the drawn mesh
  double geometric_error_m = 0;      // bound for the drawn mesh
  double screen_space_error_px = 0;  // bound for the drawn mesh
  ControlTerms terms;                // for the coarsest mesh, as in select()
  double shift = 0;                  // metric kError: levels by which the error counted more
  int wanted_level = 0;              // metric kDistance: the level that control asks for
  LevelReason reason = LevelReason::kWithinTolerance;
};

// Returns an explanation for every tile of the selection, in its order. The first three arguments must be those
// of select(). The terms include the x of functions whose weight is 0.
std::vector<TileExplanation> explain(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                                     const Selection& selection);

}  // namespace lod
