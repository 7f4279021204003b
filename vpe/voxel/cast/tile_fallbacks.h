// Coarser tiles in place of tiles that cannot be cast: those that are not held while an image may not wait for
// storage, and those that cannot be read.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): between ThreadLocalTiles and HeightGridStore. One
// TileFallbacks serves an image.
//
// The column walk keeps to the tiles that it selects. A tile that is not there is cast with the posts of its
// nearest ancestor that is (FallbackTile in height_grid.h), so that one absent tile makes nothing else coarser.
// A tile that is not held while its four children are is replaced by them.
//
// Typical usage:
//   TileFallbacks fallbacks(store, exaggeration, ReadingRule::never());
//   caster.cast(view, options, pool, range_m, sectors, &fallbacks);
//   for (const AbsentTile& tile : fallbacks.absent()) load(tile);
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/cast/reading_rule.h"

namespace vpe::voxel {

// A tile that an image needed and that was not there.
struct AbsentTile {
  lod::TileTree::Index tile = 0;
  // The ancestor whose posts were cast. Equal to `tile` where its children were cast, or where it was only
  // absent for single rays.
  lod::TileTree::Index source = 0;
  LineFamily family = LineFamily::kColumns;  // that was needed first
  bool for_single_rays = false;              // the tile of paging::Surface
  std::optional<std::string> failure;        // why it cannot be read; absent: not loaded yet
};

// Any thread may call any member. What is decided of a tile holds for the whole image.
class TileFallbacks {
 public:
  using Tile = lod::TileTree::Index;

  // Serves one image. The tile below the camera is read even where the rule forbids it, as the image depends on it
  // most, unless the image is a hint: one that shall only find what is absent. `store` must outlive this.
  enum class Purpose : std::uint8_t { kImage, kHint };
  TileFallbacks(const HeightGridStore& store, double exaggeration, ReadingRule rule,
                Purpose purpose = Purpose::kImage);

  Purpose purpose() const { return purpose_; }

  // Return the grids of a tile, or of what stands in for it. The roots, and tiles in double (exact_grids()),
  // are read in any case. Throw paging::PlanetError if not even the root can be read.
  std::shared_ptr<const TileHeightGrids<float>> grids(Tile tile, LineFamily family);
  std::shared_ptr<const TileHeightGrids<double>> exact_grids(Tile tile, LineFamily family);
  std::shared_ptr<const TileHeightGrids<float>> any_grids(Tile tile);

  // Return the grids of a tile with half its intervals, with the posts of `parent` or of what stands in for that.
  std::shared_ptr<const TileHeightGrids<float>> half_grids(Tile tile, Tile parent, LineFamily family);
  std::shared_ptr<const TileHeightGrids<double>> exact_half_grids(Tile tile, Tile parent, LineFamily family);

  // Returns true if the children of a tile are to be cast in its place: it is not held, and they are.
  bool prefers_children(Tile tile);
  // Reads a tile even if nothing else may be read.
  void require(Tile tile) { store_.read(tile, LineFamily::kColumns, exaggeration_); }

  // Returns a tile for single rays, or null if it is not held and may not be read, or cannot be read.
  std::shared_ptr<const paging::SurfaceTile> surface_tile(const paging::Surface& surface,
                                                          const lod::TileKey& key);

  // Returns the tile whose posts are cast for `tile`: an ancestor if it was replaced, else itself.
  Tile source_of(Tile tile) const;
  // Returns what was absent, by tile.
  std::vector<AbsentTile> absent() const;

 private:
  // Returns what stands in for the tile if it is not there.
  std::optional<Tile> replacement(Tile tile, LineFamily family);
  Tile nearest_ancestor(Tile tile, LineFamily family);
  Tile parent(Tile tile) const;
  bool is_there(Tile tile, LineFamily family) const;
  bool read(Tile tile, LineFamily family) const;
  bool are_children_held(Tile tile, int levels) const;

  const HeightGridStore& store_;
  const lod::TileTree& tree_;
  double exaggeration_;
  ReadingRule rule_;
  Purpose purpose_;
  mutable std::shared_mutex mutex_;
  std::atomic<bool> any_replaced_{false};
  struct Replacement {
    Tile source;  // an ancestor; or the tile itself, if its children stand in
    LineFamily family;
  };
  std::unordered_map<Tile, Replacement> replaced_;
  std::unordered_set<Tile> absent_for_single_rays_;
};

}  // namespace vpe::voxel
