// The tiles that a patch makes.
//
// Typical usage:
//   const PatchPlanner planner(planet->tree());
//   const auto plan = planner.plan(change, {.most_finest_tiles = 100});
//   for (const lod::TileKey& key : plan->leaves) make(key);
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "lod/tree/tree.h"
#include "paging/live/patch_maker.h"
#include "paging/plan/build_plan.h"

namespace paging {

struct PatchPlan {
  std::shared_ptr<const BuildPlan> tiles;  // of the planet with the patch
  std::vector<lod::TileKey> leaves;        // that are made, in Morton order
  std::vector<lod::TileKey> inner;         // all above these, deepest first
  bool is_coarser = false;                 // as MadePatch
};

// Plans patches of one planet. Any number of threads may call plan() at once.
class PatchPlanner {
 public:
  explicit PatchPlanner(const lod::TileTree& tree);  // which must outlive this

  // Returns the tiles of a change: finest ones that it touches, at the spacing that it wants; those that must be
  // finer beside them; and those whose borders then have other neighbours. Throws PlanetError when the change touches more
  // finest tiles of the planet than may be made.
  PatchPlan plan(const GroundChange& change, const PatchOptions& options) const;

 private:
  // Holds a tree with the finest tiles that have other neighbours in it than in the planet, or are not in the planet.
  struct Divided {
    std::vector<lod::TileKey> keys;  // that were divided, before balancing
    std::shared_ptr<const BuildPlan> tiles;
    std::vector<lod::TileKey> leaves;
  };

  std::shared_ptr<const Divided> divided(std::vector<lod::TileKey> keys) const;

  const lod::TileTree& tree_;
  std::shared_ptr<const BuildPlan> base_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Divided> last_;  // an animation mostly divides the same tiles again
};

}  // namespace paging
