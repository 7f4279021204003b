// The checks of one tile. Used by verify() alone.
#pragma once

#include "paging/planet/verify.h"

namespace paging {

// What the checks of one tile found; added up in tile order.
struct TileFindings {
  VerifyReport report;  // problems and counts of this tile alone
  void problem(const lod::TileKey& key, const std::string& what);
};

// Posts, range, slope, meshes, and the borders that this tile looks after: towards neighbours of its own level
// that come later in key order, and towards coarser ones.
TileFindings check_tile(const PlanetFile& planet, const lod::TileInfo& tile);

// Its own meshes and its ancestors' against S over this finest tile.
TileFindings measure_tile(const PlanetFile& planet, const lod::TileInfo& leaf);

TileFindings check_image(const PlanetFile& planet, const lod::TileKey& key);

}  // namespace paging
