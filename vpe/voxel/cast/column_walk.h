// Leads groups of columns over the planet: tiles from near to far, without those that cannot be seen.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): one ColumnWalk serves an image. cast_columns()
// (column_batch.h) calls cast() for every group; cast() calls walk_grid() (columns.h) for each height grid on
// the group's path. SectorCaster and march_fixed_steps() use the same choice of tiles through FacetFinder
// (facet_finder.h).
#pragma once

#include <atomic>
#include <vector>

#include "lod/control.h"
#include "lod/tree/tree.h"
#include "paging/surface/surface.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/cast/tile_usage.h"
#include "vpe/voxel/columns/columns.h"

namespace vpe::voxel {

// Selects the tiles that are fine enough: those whose posts, drawn as a grid, are within cell_px of the
// reference surface in the image, wherever they appear (so crests sink by no more than that). Planet files
// before format 1.2 do not record this error; there, tiles are fine enough whose posts are at most cell_px
// apart in the image.
//
// Where a tile is not fine enough as a whole, each quarter of it is by itself, by its own distance: the child that
// covers it is then cast with the tile's posts, with half as many lines as with its own.
//
// Level control changes that as it changes the selection of triangles (lod/control.h): with the metric kError a
// tile's error, or the distance of its posts, counts 2^levels times; with the metric kDistance a tile is fine
// enough from the wanted level on, whatever its error.
struct CellRule {
  // Smaller: closer to the reference surface, slower; larger: coarser tiles, fewer to read and walk. 0: the
  // finest tiles alone, so the reference surface itself; level control has no effect then.
  double cell_px = 0;
  double focal_px = 1;                         // pixels per radian at the image's centre (core::focal_px)
  const lod::LevelControl* control = nullptr;  // null: neutral; must outlive the walk
  lod::CentreOfView centre = {};
  // Cells of the discrete walk (discrete.h) are at most cell_px wide in the image, whatever their error, and the finest where
  // cell_px is 0. Tiles are cast by that walk.
  bool is_discrete = false;
  bool blends = false;  // voxels go over to those twice as wide, by distance; with is_discrete alone
};

// Holds what all groups of one image share: camera, exaggeration, and the tiles' bounds seen from there.
// Threads may share it.
class ColumnWalk {
 public:
  // Requires a camera above the reference surface: camera.distance_m > camera.ground_m. `surface` and `fallbacks`
  // must outlive this. Without fallbacks every tile is read.
  ColumnWalk(const paging::Surface& surface, const ColumnCamera& camera, double exaggeration,
             const CellRule& rule, TileFallbacks* fallbacks = nullptr);

  // Resolves all rows of a group of columns that see ground. `azimuth` holds a vector for each column (unit,
  // body-fixed, normal to camera.up), neighbours in order. Rows, slope coefficients and buffers of `group` must
  // be set. Throws paging::PlanetError for tiles that cannot be read.
  void cast(const glm::dvec3* azimuth, const Rows& rows, ThreadLocalTiles& tiles, ColumnGroup& group) const;

  const ColumnCamera& camera() const { return camera_; }
  // Returns true if tiles are walked by walk_grid_discretely().
  bool is_discrete() const { return rule_.is_discrete; }
  const lod::TileTree& tree() const { return tree_; }

  // Returns true if nothing below the tile is cast: its own posts are, because it is fine enough or the finest
  // there; or its parent's, because they are fine enough over the tile; or those of an ancestor in their place
  // (tile_fallbacks.h).
  bool ends_at(lod::TileTree::Index tile) const;
  // Return, for a tile that ends_at() has returned true for: whether its parent's posts are cast, and the intervals
  // of what is cast along the tile's side.
  bool has_parents_posts(lod::TileTree::Index tile) const;
  int intervals(lod::TileTree::Index tile) const {
    return has_parents_posts(tile) ? tree_.shape().intervals() / 2 : tree_.shape().intervals();
  }
  // Counts a tile among those that casts have used.
  void mark_used(lod::TileTree::Index tile) const;
  // Returns a lower bound of the distance from the camera to the tile's posts.
  double least_distance_m(lod::TileTree::Index tile) const;
  // Returns the tile whose posts are cast below the camera.
  lod::TileTree::Index below_camera() const;

  // Returns the radius of the highest ground, as exaggerated.
  double highest_m() const { return highest_m_; }
  double exaggeration() const { return exaggeration_; }

  using Usage = TileUsage;
  // Returns the usage of all casts so far.
  Usage usage() const;

  // Returns the chart line through the middle of cell `index` of 2^level cells along a side of a face.
  double middle_line(int level, std::int32_t index) const { return surface_.middle_line(level, index); }

 private:
  friend class GroupWalk;
  // Range of central angles, in radians, that a tile lies within.
  struct Angles {
    double near;
    double far;
  };
  Angles angles(lod::TileTree::Index tile) const;
  // Returns the bound of the distance between the tile's posts as a grid and the reference surface, as the planet
  // file states it; infinite if the file does not record it.
  double measured_error_m(lod::TileTree::Index tile) const;
  // Returns the same bound, from the spacing of the posts where the file does not record it.
  double posts_error_m(lod::TileTree::Index tile) const;
  // Returns the bound for a tile that is cast with the posts of `source`, an ancestor of it.
  double fallback_error_m(lod::TileTree::Index tile, lod::TileTree::Index source) const;
  double spacing_m(lod::TileTree::Index tile) const;  // of posts, nominal
  double reach_m(lod::TileTree::Index tile) const;
  // Returns the largest screen-space error that a geometric error at this tile can cause.
  double in_image_px(double geometric_error_m, lod::TileTree::Index tile) const;
  lod::TileTree::Index parent(lod::TileTree::Index tile) const;  // of a tile that is no root
  // Returns how far the samples of the discrete walk are from the tile's posts as a grid.
  double voxel_error_m(lod::TileTree::Index tile) const;
  // Returns the range from which on voxels of the tile's own go over to wider ones; 0 if they never do.
  double blend_from_m(lod::TileTree::Index tile) const;
  // Returns true if the posts of `posts_of`, the tile itself or its parent, are fine enough over the tile by the
  // rule, whatever is there.
  bool is_fine(lod::TileTree::Index tile, lod::TileTree::Index posts_of) const;
  // Returns true if the tile is to be cast with its parent's posts. Expects that the parent is not fine enough as a
  // whole.
  bool takes_parents_posts(lod::TileTree::Index tile) const;

  // Returns an upper bound of the slope tan(e) of all rays that meet the tile.
  float slope_bound(lod::TileTree::Index tile) const;

  const paging::Surface& surface_;
  const lod::TileTree& tree_;
  ColumnCamera camera_;
  double exaggeration_;
  double highest_m_;
  CellRule rule_;
  TileFallbacks* fallbacks_;
  // Computed on first use; NaN and 0 before. What is stored first stays. ends_ also tells whose posts are cast,
  // and marks the tiles that were used.
  mutable std::vector<std::atomic<float>> bounds_;
  mutable std::vector<std::atomic<std::uint8_t>> ends_;
};

}  // namespace vpe::voxel
