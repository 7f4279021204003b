// Keeps the height grids of a planet's tiles within a budget, for all threads that cast.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): between the planet file and the column walk. A renderer has
// one store for all images; each thread puts ThreadLocalTiles before it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "lod/tree/tree.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/lru_cache.h"
#include "vpe/voxel/cast/height_grid.h"

namespace vpe::voxel {

// Any thread may call any member. Returned grids are immutable and live as long as they are held.
class HeightGridStore {
 public:
  // The budget limits the grids that are kept. Smaller: grids are read and made again; larger: more memory.
  HeightGridStore(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  const paging::PlanetFile& planet() const { return *planet_; }

  // Returns the grids of a tile. Throws paging::PlanetError if the tile cannot be read, as the functions below
  // do.
  std::shared_ptr<const TileHeightGrids<float>> grids(lod::TileTree::Index tile, LineFamily family,
                                                      double exaggeration) const;
  // Returns the grids in double, for the tiles below the camera.
  std::shared_ptr<const TileHeightGrids<double>> exact_grids(lod::TileTree::Index tile, LineFamily family,
                                                             double exaggeration) const;

  // Returns the grids in any family that is held, else in kColumns, and sets `family`. All families hold the
  // same posts.
  std::shared_ptr<const TileHeightGrids<float>> any_grids(lod::TileTree::Index tile, double exaggeration,
                                                          LineFamily& family) const;

  std::size_t bytes_resident() const;
  std::size_t budget_bytes() const { return budget_; }

  // Counts all grids that were ever made from the planet file, those that have left the store included.
  struct BuildTotals {
    std::int64_t tiles = 0;
    std::size_t bytes = 0;
  };
  BuildTotals build_totals() const { return {tiles_made_, bytes_made_}; }

 private:
  struct Key {
    lod::TileTree::Index tile;
    LineFamily family;
    double exaggeration;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      return (std::size_t{k.tile} * kFamilies + static_cast<std::size_t>(k.family)) * 0x9e3779b97f4a7c15ULL ^
             std::hash<double>()(k.exaggeration);
    }
  };
  template <typename T>
  using Cache = vpe::base::LruCache<Key, TileHeightGrids<T>, KeyHash>;
  template <typename T>
  std::shared_ptr<const TileHeightGrids<T>> get(Cache<T>& cache, const Key& key) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::size_t budget_;
  mutable std::atomic<std::int64_t> tiles_made_{0};
  mutable std::atomic<std::size_t> bytes_made_{0};
  mutable Cache<float> grids_;
  mutable Cache<double> exact_;
};

// Remembers the grids that one thread used last, so that it finds them again without a lock. Not synchronised.
class ThreadLocalTiles {
 public:
  // `store` must outlive this.
  ThreadLocalTiles(const HeightGridStore& store, double exaggeration)
      : store_(store), exaggeration_(exaggeration) {}

  // Return what the store's functions of the same names return, and throw what they throw. References are valid
  // until the next call.
  const TileHeightGrids<float>& grids(lod::TileTree::Index tile, LineFamily family);
  const TileHeightGrids<double>& exact_grids(lod::TileTree::Index tile, LineFamily family);
  const TileHeightGrids<float>& any_grids(lod::TileTree::Index tile, LineFamily& family);

 private:
  template <typename T>
  struct Slot {
    lod::TileTree::Index tile = ~lod::TileTree::Index{0};
    LineFamily family = LineFamily::kColumns;
    std::shared_ptr<const TileHeightGrids<T>> held;
    bool is(lod::TileTree::Index t, LineFamily f) const { return tile == t && family == f && held; }
  };
  static std::size_t number(lod::TileTree::Index tile, LineFamily family) {
    return std::size_t{tile} * kFamilies + static_cast<std::size_t>(family);
  }

  const HeightGridStore& store_;
  double exaggeration_;
  std::array<Slot<float>, 256> slots_;
  std::array<Slot<double>, 8> exact_;
};

}  // namespace vpe::voxel
