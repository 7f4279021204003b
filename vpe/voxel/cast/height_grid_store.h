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
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "lod/tree/tree.h"
#include "paging/planet/planet_file.h"
#include "paging/planet/tile_version.h"
#include "vpe/base/lru_cache.h"
#include "vpe/voxel/columns/height_grid.h"

namespace vpe::voxel {

// Any thread may call any const member. Returned grids are immutable and live as long as they are held.
class HeightGridStore {
 public:
  using Tile = lod::TileTree::Index;
  template <typename T>
  using Pointer = std::shared_ptr<const TileHeightGrids<T>>;

  // The budget limits the grids that are kept. Smaller: grids are read and made again; larger: more memory.
  HeightGridStore(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Goes over to another version of the planet, as paging::PlanetUser::change_planet(). No other member may run
  // meanwhile.
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet);

  const paging::PlanetFile& planet() const { return *planet_; }

  // Returns the grids of a tile; reads it unless a family of it is held. Throws paging::PlanetError if the tile
  // cannot be read, as the functions below do.
  Pointer<float> grids(Tile tile, LineFamily family, double exaggeration) const;
  // Returns the grids in double, for the tiles below the camera. Then grids() of the tile are held too.
  Pointer<double> exact_grids(Tile tile, LineFamily family, double exaggeration) const;

  // Returns the grids in any family that is held, else in kColumns. All families hold the same posts.
  Pointer<float> any_grids(Tile tile, double exaggeration) const;
  // Returns the grids in any family that is held, or null. Reads nothing.
  Pointer<float> held_grids(Tile tile, double exaggeration) const;

  // Returns grids of `tile` with the posts of `coarser`, an ancestor of it (FallbackTile in height_grid.h).
  Pointer<float> fallback_grids(Tile tile, Tile coarser, LineFamily family, double exaggeration) const;
  Pointer<double> exact_fallback_grids(Tile tile, Tile coarser, LineFamily family, double exaggeration) const;

  // Return grids of `tile` with half its intervals, for the posts of its parent: from the parent if `coarser` is that, else
  // from an ancestor that stands in for it.
  Pointer<float> half_grids(Tile tile, Tile coarser, LineFamily family, double exaggeration) const;
  Pointer<double> exact_half_grids(Tile tile, Tile coarser, LineFamily family, double exaggeration) const;

  // Returns why a tile could not be read before, or nullopt. Such a tile is not read again by read().
  std::optional<std::string> failure(Tile tile) const;
  // Reads a tile in a family, unless any family of it is held. Returns false and records the failure if it cannot
  // be read.
  bool read(Tile tile, LineFamily family, double exaggeration) const;
  // Records that a tile cannot be read, for readers of other forms of it.
  void record_failure(Tile tile, const std::string& why) const;

  std::size_t bytes_resident() const;
  std::size_t budget_bytes() const { return budget_; }
  // Changes the budget and removes what exceeds it.
  void set_budget(std::size_t bytes) const;

  // Counts all grids that were ever made, those that have left the store included.
  struct BuildTotals {
    std::int64_t tiles = 0;
    std::size_t bytes = 0;
  };
  BuildTotals build_totals() const { return {tiles_made_, bytes_made_}; }

 private:
  // Indices of tiles do not outlast a change of the planet.
  struct Key {
    paging::TileVersion tile;
    std::int32_t posts_level;     // of `tile`, or of the ancestor that its posts are from
    std::uint64_t posts_version;  // of that tile
    bool is_half;                 // half_grids()
    LineFamily family;
    double exaggeration;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      return (paging::TileVersionHash()(k.tile) * kFamilies + static_cast<std::size_t>(k.family)) *
                 0x9e3779b97f4a7c15ULL +
             2 * static_cast<std::size_t>(k.posts_level) + (k.is_half ? 1 : 0) +
             (std::hash<double>()(k.exaggeration) ^ k.posts_version);
    }
  };
  Key key(Tile tile, Tile posts_of, LineFamily family, double exaggeration, bool is_half = false) const;
  template <typename T>
  using Cache = vpe::base::LruCache<Key, TileHeightGrids<T>, KeyHash>;
  template <typename T>
  Pointer<T> find(Cache<T>& cache, Tile tile, double exaggeration) const;
  template <typename T, typename Make>
  Pointer<T> get(Cache<T>& cache, const Key& key, const Make& make) const;
  template <typename T>
  Pointer<T> fallback(Cache<T>& cache, Tile tile, Tile coarser, LineFamily family, double exaggeration,
                      bool is_half) const;
  paging::TileHeights heights(Tile tile, double exaggeration) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  mutable std::atomic<std::size_t> budget_;
  mutable std::atomic<std::int64_t> tiles_made_{0};
  mutable std::atomic<std::size_t> bytes_made_{0};
  mutable Cache<float> grids_;
  mutable Cache<double> exact_;
  mutable std::atomic<bool> any_failed_{false};
  mutable std::mutex failures_mutex_;
  mutable std::unordered_map<Tile, std::string> failures_;
};

class TileFallbacks;  // tile_fallbacks.h

// Remembers the grids that one thread used last, so that it finds them again without a lock. Not synchronised.
class ThreadLocalTiles {
 public:
  // `store` and `fallbacks` must outlive this. Without fallbacks every tile is read.
  ThreadLocalTiles(const HeightGridStore& store, double exaggeration, TileFallbacks* fallbacks)
      : store_(store), exaggeration_(exaggeration), fallbacks_(fallbacks) {}

  // Return the grids of a tile, or of what stands in for it. References are valid until the next call. Throw
  // paging::PlanetError: without fallbacks for each tile that cannot be read, else where no ancestor can be
  // read. any_grids() chooses the family that costs least.
  template <typename T>
  using Pointer = HeightGridStore::Pointer<T>;
  const Pointer<float>& grids(lod::TileTree::Index tile, LineFamily family);
  const Pointer<double>& exact_grids(lod::TileTree::Index tile, LineFamily family);
  const Pointer<float>& any_grids(lod::TileTree::Index tile);

  // Return the grids of a tile with the posts of `posts_of`: of the tile itself, or of its parent
  // (HeightGridStore::half_grids()). Which of the two must be the same in all calls.
  const Pointer<float>& grids(lod::TileTree::Index tile, lod::TileTree::Index posts_of, LineFamily family);
  const Pointer<double>& exact_grids(lod::TileTree::Index tile, lod::TileTree::Index posts_of,
                                     LineFamily family);
  const Pointer<float>& any_grids(lod::TileTree::Index tile, lod::TileTree::Index posts_of);

 private:
  template <typename T>
  struct Slot {
    lod::TileTree::Index tile = ~lod::TileTree::Index{0};
    LineFamily family = LineFamily::kColumns;
    Pointer<T> held;
    bool is(lod::TileTree::Index t, LineFamily f) const { return tile == t && family == f && held; }
  };
  static std::size_t number(lod::TileTree::Index tile, LineFamily family) {
    return std::size_t{tile} * kFamilies + static_cast<std::size_t>(family);
  }

  const HeightGridStore& store_;
  double exaggeration_;
  TileFallbacks* fallbacks_;
  std::array<Slot<float>, 256> slots_;
  std::array<Slot<double>, 8> exact_;
};

}  // namespace vpe::voxel
