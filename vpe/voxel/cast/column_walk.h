// The way of a group of columns over the planet: tiles from near to far, without those that cannot be seen.
#pragma once

#include <atomic>
#include <vector>

#include "lod/tree/tree.h"
#include "paging/surface/surface.h"
#include "vpe/voxel/cast/columns.h"
#include "vpe/voxel/cast/height_grid_store.h"

namespace vpe::voxel {

// Which tiles are fine enough: those whose posts, drawn as a grid, are within cell_px of S in the image
// wherever they are (so crests sink by no more than that). In planet files that do not say how far they are
// (before 1.2): those whose posts are at most cell_px apart there.
struct CellRule {
  double cell_px = 0;   // 0: none but the finest, so S itself
  double focal_px = 1;  // pixels per radian, at most
};

// Prepared for one eye and one exaggeration. Threads may share it.
class ColumnWalk {
 public:
  // The camera stands above S: camera.distance_m > camera.ground_m.
  ColumnWalk(const paging::Surface& surface, const ColumnCamera& camera, double exaggeration,
             const CellRule& rule);

  // A group of columns from their azimuth vectors (unit, body-fixed, normal to camera.up), neighbours in order.
  // Rows, fans, and buffers of `group` are set before. Resolves all rows that see ground.
  void cast(const glm::dvec3* azimuth, const Rows& rows, ThreadLocalTiles& tiles, ColumnGroup& group) const;

  const ColumnCamera& camera() const { return camera_; }
  const lod::TileTree& tree() const { return tree_; }

  // Whether the tile's own posts are cast: it is fine enough, or the finest there.
  bool ends_at(lod::TileTree::Index tile) const;

  // Radius of the highest ground, as exaggerated.
  double highest_m() const { return highest_m_; }

  // What the casts so far have used.
  struct Used {
    std::vector<int> tiles_by_level;  // index 0 = level 0
    // Bound of |drawn - S| in the image, pixels: 0 when all tiles were the finest.
    double screen_space_error_px = 0;
    double geometric_error_m = 0;  // largest of the tiles
    // Of several images of nearly one view: at least the tiles of each, and all their errors.
    void add(const Used& other);
  };
  Used used() const;

  // Chart line through the middle of a cell of 2^level a side of a face.
  double middle_line(int level, std::int32_t index) const { return surface_.middle_line(level, index); }

 private:
  friend class GroupWalk;
  // Central angles that a tile lies within.
  struct Angles {
    double near;
    double far;
  };
  Angles angles(lod::TileTree::Index tile) const;
  double least_distance_m(lod::TileTree::Index tile) const;
  void mark_used(lod::TileTree::Index tile) const;

  // Bound of |its posts as a grid - S|; infinite where the planet file does not say.
  double measured_error_m(lod::TileTree::Index tile) const;
  // What such an error makes in the image at most.
  double in_image_px(double geometric_error_m, lod::TileTree::Index tile) const;

  // No ray into the tile is steeper than this many times upward.
  float slope_bound(lod::TileTree::Index tile) const;

  const paging::Surface& surface_;
  const lod::TileTree& tree_;
  ColumnCamera camera_;
  double exaggeration_;
  double highest_m_;
  CellRule rule_;
  // Made when first wanted; NaN and 0 before. ends_ also marks the tiles that were used. Whoever makes one
  // makes the same.
  mutable std::vector<std::atomic<float>> bounds_;
  mutable std::vector<std::atomic<std::uint8_t>> ends_;
};

}  // namespace vpe::voxel
