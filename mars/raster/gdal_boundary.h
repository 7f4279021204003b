// Computes distances of pixels from the boundary of a raster's data.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "mars/raster/gdal_georeference.h"
#include "mars/raster/gdal_tiles.h"
#include "mars/sources/stack.h"

namespace mars {

// Holds the distances from nodata pixels at the pixels of a tile.
struct BoundaryTile {
  std::vector<float> posts;  // kTileStride^2; -0.5 at nodata pixels; empty: farther than the limit everywhere
  std::size_t bytes() const { return sizeof(BoundaryTile) + posts.size() * sizeof(float); }
};

// Computes a tile of exact Euclidean distances up to `limit` pixels. Calls has_data(column, row) in row order,
// for pixels inside the grid only.
BoundaryTile make_boundary_tile(const PixelGrid& grid, const TileId& id, int limit,
                                const std::function<bool(int column, int row)>& has_data);

// Sets posts[i] to the distance of a pixel position from the border of the grid and from nodata pixels, at most
// limit_posts; 0 outside. `fetch(TileId)` returns boundary tiles.
template <class Fetch>
void boundary_distances(const PixelGrid& grid, std::span<const glm::dvec2> pixels, double limit_posts,
                        const Fetch& fetch, std::span<double> posts) {
  TileCursor<BoundaryTile, Fetch> cursor(0, fetch);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    PixelNeighbourhood place;
    posts[i] = 0;
    if (!locate(grid, pixels[i].x, pixels[i].y, place)) continue;
    double distance = limit_posts;
    if (!grid.wraps) {
      const double x = place.column + place.fx;
      // locate() clamps the half pixel at the border, where the distance still decreases to 0.
      const double unclamped = grid.period > 0
                                   ? pixels[i].x - grid.period * std::round((pixels[i].x - x) / grid.period)
                                   : pixels[i].x;
      distance = std::min({distance, unclamped + 0.5, grid.width - 0.5 - unclamped});
    }
    if (!grid.has_first_pole()) distance = std::min(distance, pixels[i].y + 0.5);
    if (!grid.has_last_pole()) distance = std::min(distance, grid.height - 0.5 - pixels[i].y);
    const BoundaryTile& tile = cursor.at(place.column, place.row);
    if (!tile.posts.empty()) {
      const float* p = tile.posts.data() + TileCursor<BoundaryTile, Fetch>::offset(place.column, place.row);
      const double upper = p[0] * (1 - place.fx) + p[1] * place.fx;
      const double lower = p[kTileStride] * (1 - place.fx) + p[kTileStride + 1] * place.fx;
      distance = std::min(distance, upper * (1 - place.fy) + lower * place.fy);
    }
    posts[i] = std::max(0.0, distance);
  }
}

// Implements BoundaryAware::boundary_distance() for a raster. Keeps boundary tiles in `tiles`. has_data(column,
// row) is called for pixels inside the grid only.
template <class HasData>
void raster_boundary_distance(const Georeference& georeference, TileCache<BoundaryTile>& tiles,
                              std::span<const glm::dvec3> directions, double limit_posts,
                              const HasData& has_data, std::span<double> posts) {
  const PixelGrid& grid = georeference.grid();
  const int limit = static_cast<int>(std::ceil(std::min(limit_posts, kMaxFeather_posts)));
  const auto fetch = [&](const TileId& id) {
    // The limit takes the place of the level in the key, because tiles of several limits may coexist.
    return tiles.get({limit, id.column, id.row}, [&](const TileId& key) {
      return std::make_shared<const BoundaryTile>(
          make_boundary_tile(grid, {0, key.column, key.row}, limit, has_data));
    });
  };
  for_pixels(georeference, directions, [&](std::size_t start, std::span<const glm::dvec2> pixels) {
    boundary_distances(grid, pixels, limit_posts, fetch, posts.subspan(start, pixels.size()));
  });
}

}  // namespace mars
