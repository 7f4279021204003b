// Checks of one tile. Used by verify() alone.
#pragma once

#include "paging/planet/verify.h"

namespace paging {

// Holds the findings of one tile; verify() adds them up in tile order.
struct TileFindings {
  VerifyReport report;  // problems and counts of this tile alone
  void problem(const lod::TileKey& key, const std::string& what);
};

// Checks posts, range, slope and meshes, and the borders that belong to this tile: those to neighbours of its
// own level that come later in key order, and those to coarser neighbours.
TileFindings check_tile(const PlanetFile& planet, const lod::TileInfo& tile);

// Measures the tile's own meshes and those of its ancestors against the reference surface over this finest
// tile.
TileFindings measure_tile(const PlanetFile& planet, const lod::TileInfo& leaf);

// Checks that an image tile can be read.
TileFindings check_image(const PlanetFile& planet, const lod::TileKey& key);

}  // namespace paging
