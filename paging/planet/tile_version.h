// Versions of tiles: what caches key their pages by, so that a patch of the planet makes no other page void.
//
// Typical usage:
//   LruCache<TileVersion, Tile, TileVersionHash> tiles(64 << 20);
//   const auto tile = tiles.get({key, planet->version(key)}, [&] { return load(key); });
#pragma once

#include <cstdint>

#include "lod/tree/tile_key.h"

namespace paging {

// Names the content of a tile: a number is given to each planet that this process opens or patches, and a tile has the
// number of the planet that it came with.
struct TileVersion {
  lod::TileKey key;
  std::uint64_t version = 0;

  bool operator==(const TileVersion&) const = default;
};

struct TileVersionHash {
  std::size_t operator()(const TileVersion& tile) const {
    return lod::TileKeyHash()(tile.key) ^ static_cast<std::size_t>(tile.version * 0x9e3779b97f4a7c15ULL);
  }
};

// Says what a page of a tile is made of, and so which changes make it void.
enum class MadeOf : std::uint8_t {
  kTile,     // the tile's own row, posts and meshes
  kBorders,  // these, and the posts next to its borders in the tiles across them: normals
  // All posts and texels in the tile, at any level, and posts across its borders: textures, which may be finer than
  // the tile's posts.
  kArea,
  kImage,  // an image tile alone
};

}  // namespace paging
