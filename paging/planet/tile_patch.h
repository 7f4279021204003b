// A patch: tiles that replace or refine those of a planet, in memory. PlanetFile::with() lays it over the planet.
//
// Typical usage:
//   auto patch = std::make_shared<TilePatch>();
//   patch->tiles.push_back({row, payload, {}});
//   patch->meta = meta;  // of the planet with the patch
//   const std::shared_ptr<const PlanetFile> patched = planet->with(std::move(patch));
#pragma once

#include <cstdint>
#include <vector>

#include "paging/planet/planet_meta.h"
#include "paging/planet/tile_payload.h"

namespace paging {

// Holds a tile that replaces the planet's tile of the same key, or that is new.
struct PatchTile {
  NodeRow row;  // with its final error terms
  TilePayload payload;
  std::vector<SourceResampling> resampling;  // of a finest tile, as TileSources::resampling
};

// Holds an image tile that replaces the planet's, or that is new.
struct PatchImage {
  std::int64_t key = 0;
  Bytes jpeg;  // 257 x 257 texels
};

// Holds all tiles that differ from the planet's, in any order: those with other posts, meshes, bounds or neighbours,
// and their ancestors as far as these differ. A finest tile of the planet may become an inner one whose four children
// the patch has. A patch removes no tile.
struct TilePatch {
  std::vector<PatchTile> tiles;
  std::vector<PatchImage> images;
  // Describes the planet with the patch: bounds of its radius, counts, levels (they may be empty), sources. Body,
  // radius, datum, shape, tile shape and quantum are the planet's. `identity` does not count.
  PlanetMeta meta;
  // The number in meta.sources of each of the planet's elevation sources, ascending; tiles that the patch leaves name
  // them so from then on. Empty: they keep their numbers, and new sources come after them.
  std::vector<int> source_numbers;
};

}  // namespace paging
