// Places among the tiles of a tree and among the grid lines of a tile. Internal to paging/surface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "lod/tree/posts.h"
#include "lod/tree/tree.h"
#include "mars/geodesy/cube.h"
#include "paging/surface/surface.h"

namespace paging {

// Returns the finest tile of a tree at a place.
inline lod::TileKey finest_tile(const lod::TileTree& tree, const mars::ChartPoint& point) {
  lod::TileKey key = lod::tile_at(point, 0);
  for (const lod::TileInfo* info = tree.find(key); info != nullptr && info->has_children;
       info = tree.find(key)) {
    key = lod::tile_at(point, key.level + 1);
  }
  return key;
}

// Holds a place among grid lines: the interval, and the fraction of it that lies before the place.
struct PlaceBetweenLines {
  std::size_t interval = 0;
  double fraction = 0;
};

// Returns where `x` lies among lines that ascend; outside of them at the nearest end.
inline PlaceBetweenLines place_between(const std::vector<double>& lines, double x) {
  const auto n =
      static_cast<std::size_t>(std::upper_bound(lines.begin() + 1, lines.end() - 1, x) - lines.begin() - 1);
  return {n, std::clamp((x - lines[n]) / (lines[n + 1] - lines[n]), 0.0, 1.0)};
}

// Returns whether a post of the facet at a place of the tile has no data.
bool is_nodata(const SurfaceTile& tile, const mars::ChartPoint& point);

// Returns the point of a finest tile at a place in it, as Surface::at() does. `planet_radius_m` is that of the sphere.
SurfacePoint point_in(const SurfaceTile& tile, const mars::ChartPoint& point, double planet_radius_m,
                      double exaggeration);

}  // namespace paging
