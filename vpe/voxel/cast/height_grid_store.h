// Lattices of a planet's tiles, kept within a budget and shared by all threads that cast columns.
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

// Any thread may call any member. What is returned stays as it is for as long as it is held.
class HeightGridStore {
 public:
  HeightGridStore(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  const paging::PlanetFile& planet() const { return *planet_; }

  // Throw paging::PlanetError for a tile that cannot be read.
  std::shared_ptr<const TileHeightGrids<float>> grids(lod::TileTree::Index tile, LineFamily family,
                                                      double exaggeration) const;
  // In double: for the tiles about the camera's foot.
  std::shared_ptr<const TileHeightGrids<double>> exact_grids(lod::TileTree::Index tile, LineFamily family,
                                                             double exaggeration) const;

  // In whatever family is there; the same posts in all of them.
  std::shared_ptr<const TileHeightGrids<float>> any_grids(lod::TileTree::Index tile, double exaggeration,
                                                          LineFamily& family) const;

  std::size_t bytes_resident() const;
  std::size_t budget_bytes() const { return budget_; }
  // All that was ever made from the planet file, also what is gone.
  struct Made {
    std::int64_t tiles = 0;
    std::size_t bytes = 0;
  };
  Made made() const { return {tiles_made_, bytes_made_}; }

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

// What one thread used last: finding it again takes no lock.
class ThreadLocalTiles {
 public:
  ThreadLocalTiles(const HeightGridStore& store, double exaggeration)
      : store_(store), exaggeration_(exaggeration) {}

  // Valid until the next call.
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
