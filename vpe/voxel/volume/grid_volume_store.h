// Keeps the terrain volumes of a planet's height grids within a budget, for all threads that cast.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): between HeightGridStore and the caster of volumes (band_caster.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "vpe/base/lru_cache.h"
#include "vpe/voxel/columns/height_grid.h"
#include "vpe/voxel/volume/grid_volume.h"

namespace vpe::voxel {

// Any thread may call any const member. Returned volumes live as long as they are held.
class GridVolumeStore {
 public:
  using Grids = std::shared_ptr<const TileHeightGrids<float>>;
  using Pointer = std::shared_ptr<const GridVolume>;

  // Smaller: volumes are made again more often. They are not kept beyond it.
  explicit GridVolumeStore(std::size_t budget_bytes) : cache_(budget_bytes) {}

  // Returns the volume of grid (i, j) of a tile's grids, which lies on a face in a frame. It is kept with the grids, so that
  // others at the same place in memory are never taken for them. Throws what make_grid_volume() throws.
  Pointer get(const Grids& grids, int i, int j, mars::Face face, const HeightGridFrame& frame, double radius_m,
              const BandSpec& spec) const;

  std::size_t bytes_resident() const { return cache_.bytes(); }

 private:
  struct Key {
    const void* grids = nullptr;
    int place = 0;
    BandSpec spec;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return (std::hash<const void*>()(key.grids) * 0x9e3779b97f4a7c15ULL +
              static_cast<std::size_t>(key.place)) *
                 3 +
             static_cast<std::size_t>(key.spec.filter);
    }
  };
  struct Kept {
    GridVolume volume;
    Grids grids;
  };

  mutable base::LruCache<Key, Kept, KeyHash> cache_;
};

}  // namespace vpe::voxel
