// Finds the ground that mode multires draws for a camera, from the posts of its tiles.
#pragma once

#include <glm/geometric.hpp>
#include <map>
#include <mutex>

#include "lod/tree/posts.h"
#include "mars/geodesy/cube.h"
#include "paging/surface/surface.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_walk.h"

namespace test_support {

// Finds the tile that a view draws at a place. Pops of its posts are free of interpolation, but do not show how
// rays find the ground.
class DrawnGround {
 public:
  DrawnGround(const paging::Surface& surface, const vpe::core::View& view, double cell_px)
      : walk_(surface, camera(surface, view.camera.position_m), 1, {cell_px, vpe::core::focal_px(view)}) {}

  // Returns the tile whose posts are drawn along a direction.
  lod::TileTree::Index tile(const glm::dvec3& direction) const {
    const mars::ChartPoint at = mars::chart_point(direction);
    const lod::TileTree& tree = walk_.tree();
    auto tile = static_cast<lod::TileTree::Index>(at.face);
    lod::TileTree::Index parent = tile;
    while (!walk_.ends_at(tile)) {
      const lod::TileKey& key = tree[tile].key;
      parent = tile;
      tile = tree.first_child(tile) + (at.u >= walk_.middle_line(key.level, key.i) ? 1U : 0U) +
             (at.v >= walk_.middle_line(key.level, key.j) ? 2U : 0U);
    }
    return walk_.has_parents_posts(tile) ? parent : tile;
  }

 private:
  static vpe::voxel::ColumnCamera camera(const paging::Surface& surface, const glm::dvec3& camera_m) {
    const double distance = glm::length(camera_m);
    return {camera_m / distance, distance, surface.planet_radius_m(), surface.at(camera_m).radius_m};
  }

  vpe::voxel::ColumnWalk walk_;
};

// Keeps the posts of tiles, for all threads.
class PostsOf {
 public:
  explicit PostsOf(const paging::PlanetFile& planet) : planet_(planet) {}

  // Returns the radius of a tile's ground along a direction.
  double radius_m(lod::TileTree::Index tile, const glm::dvec3& direction) {
    const Tile& t = get(tile);
    const mars::ChartPoint at = mars::chart_on(t.posts.key.face, direction);
    return planet_.radius_m() + lod::surface_height(t.posts, t.lines, at.u, at.v, planet_.radius_m());
  }

 private:
  struct Tile {
    lod::Posts posts;
    lod::GridLines lines;
  };
  const Tile& get(lod::TileTree::Index tile) {
    const std::lock_guard lock(mutex_);
    auto [at, is_new] = tiles_.try_emplace(tile);
    if (is_new) {
      at->second.posts = planet_.heights(planet_.tree()[tile].key).posts;
      at->second.lines = lod::grid_lines(at->second.posts.key, at->second.posts.intervals);
    }
    return at->second;
  }

  const paging::PlanetFile& planet_;
  std::mutex mutex_;
  std::map<lod::TileTree::Index, Tile> tiles_;
};

}  // namespace test_support
