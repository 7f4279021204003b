// A store in which the steps of a build put tiles and read them back: a planet file that grows, or tiles in memory.
#pragma once

#include "lod/tree/tile_key.h"
#include "paging/planet/planet_meta.h"
#include "paging/planet/tile_payload.h"

namespace paging {

// Holds tiles. Any thread may call its members.
class TileStore {
 public:
  virtual ~TileStore() = default;

  // Stores a tile, whole or not at all.
  virtual void put_tile(const NodeRow& row, const TilePayload& payload) = 0;

  // Return what is stored of a tile, as in TilePayload. Throw an exception for a tile that is not there.
  virtual Bytes heights(const lod::TileKey& key) = 0;
  virtual Bytes nodata(const lod::TileKey& key) = 0;
  virtual Bytes mesh(const lod::TileKey& key, int variant) = 0;
};

}  // namespace paging
