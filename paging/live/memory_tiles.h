// Tiles in memory over those of a planet.
#pragma once

#include <mutex>
#include <unordered_map>
#include <vector>

#include "paging/planet/planet_file.h"
#include "paging/planet/tile_patch.h"
#include "paging/planet/tile_store.h"

namespace paging {

// Holds the tiles that were put, and reads all others from a planet.
class MemoryTiles : public TileStore {
 public:
  explicit MemoryTiles(const PlanetFile& planet) : planet_(planet) {}  // which must outlive this

  void put_tile(const NodeRow& row, const TilePayload& payload) override;

  // Return, of a tile of the planet, what read_posts() and the meters take for the same: posts on borders with
  // coarser neighbours lie on the edges of these already. Throw PlanetError.
  Bytes heights(const lod::TileKey& key) override;
  Bytes nodata(const lod::TileKey& key) override;
  Bytes mesh(const lod::TileKey& key, int variant) override;

  // Returns the tiles that were put, ordered by key. Nothing is held afterwards.
  std::vector<PatchTile> take();
  // Replaces the row of a tile that was put.
  void replace_row(const NodeRow& row);

 private:
  const TilePayload* find(const lod::TileKey& key);

  const PlanetFile& planet_;
  std::mutex mutex_;
  std::unordered_map<std::int64_t, PatchTile> tiles_;  // references to elements stay valid
};

}  // namespace paging
