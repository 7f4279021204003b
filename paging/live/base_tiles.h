// Keeps decoded what patches read of their planet's tiles again and again.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "lod/mesh/grid_meter.h"
#include "paging/build/build_steps.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/lru_cache.h"

namespace paging {

// Holds a tile with its first mesh.
struct BaseTile {
  std::vector<std::int32_t> quanta;  // of its own posts
  std::vector<bool> nodata;          // empty: none
  PackedMesh mesh;

  std::size_t bytes() const;
};

// Any thread may call its members. They throw PlanetError.
class BaseTiles {
 public:
  // Keeps at most about `budget_bytes`.
  BaseTiles(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes);

  const PlanetFile& planet() const { return *planet_; }

  // Returns a tile that has a mesh: one with children, or a finest one of more than its full grid.
  std::shared_ptr<const BaseTile> tile(const lod::TileKey& key) const;
  // Returns a meter of a finest tile, which measures what lies over it against the planet's surface.
  std::shared_ptr<const lod::GridMeter> meter(const lod::TileKey& leaf) const;
  // Returns what a build holds of a tile, except `lowest_m` of inner tiles. `coarser_neighbour_mask` is given, since the
  // index does not have it.
  Node node(const lod::TileKey& key, int coarser_neighbour_mask, bool with_sources) const;

 private:
  std::shared_ptr<const PlanetFile> planet_;
  mutable vpe::base::LruCache<lod::TileKey, BaseTile, lod::TileKeyHash> tiles_;
  mutable vpe::base::LruCache<lod::TileKey, lod::GridMeter, lod::TileKeyHash> meters_;
  mutable std::mutex mutex_;
  mutable std::map<lod::TileKey, std::set<int>> sources_;
};

}  // namespace paging
