// The posts of a finest tile whose ground changes.
#pragma once

#include "paging/build/build_grid.h"
#include "paging/live/ground_change.h"
#include "paging/live/planet_ground.h"

namespace paging {

// Returns a finest tile of the changed ground, as sample_leaf() does of sources. `meta` describes the planet with the
// change, whose own sources come after the `planet_sources` of the planet. `directions` of the result are empty. Throws
// PlanetError for a height that cannot be stored, and what the change throws.
SampledLeaf changed_leaf(const PlanetMeta& meta, std::size_t planet_sources, const BuildPlan& plan,
                         const GroundGrid& ground, const GroundChange& change, const lod::TileKey& key);

}  // namespace paging
