// Tiles of a finished planet file that a planet of changed sources has too.
#pragma once

#include <functional>
#include <set>
#include <span>

#include "paging/plan/build_plan.h"
#include "paging/planet/planet_meta.h"

namespace paging {

// Tells whether what a source gives may differ in a cap. It may say so of a cap in which nothing differs, never the
// reverse.
using ChangedIn = std::function<bool(const mars::Cap& cap)>;

// Describes the finished planet whose tiles may be kept.
struct FinishedTiles {
  std::span<const NodeRow> rows;              // its whole tile index
  const std::set<std::int64_t>& with_nodata;  // packed keys of tiles with nodata posts
};

// Returns the tiles that a build by `plan` would make again with the same content: finest tiles whose sources give
// the same in and around them, at the same spacings, and inner tiles above such tiles alone, with the same
// neighbours. Finest tiles with nodata posts are never among them, because these take heights from far away. Throws
// std::runtime_error when the rows are no planet's.
std::set<lod::TileKey> kept_tiles(const FinishedTiles& finished, const BuildPlan& plan, const PlanetMeta& meta,
                                  const ChangedIn& changes);

// Returns a cap that holds a tile and everything within two of its `intervals` of it: values there may be read for
// the tile's own, where a source averages.
mars::Cap surroundings(const lod::TileKey& key, int intervals);

}  // namespace paging
