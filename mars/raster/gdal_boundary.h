// Distance of pixels from the rim of a raster's data.
#pragma once

#include <cmath>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "mars/raster/gdal_tiles.h"

namespace mars {

// Distances from the holes in the data, at the pixels of a tile. Empty: farther than the limit everywhere.
struct BoundaryTile {
  std::vector<float> posts;  // kTileStride^2; -0.5 at pixels without data
  std::size_t bytes() const { return sizeof(BoundaryTile) + posts.size() * sizeof(float); }
};

// has_data(column, row) is asked for pixels inside the grid only, in row order.
BoundaryTile make_boundary_tile(const PixelGrid& grid, const TileId& id, int limit,
                                const std::function<bool(int column, int row)>& has_data);

// Distance of a place of the grid from its border and from the holes; `fetch(TileId)` gives rim tiles. 0
// outside.
template <class Fetch>
void boundary_distances(const PixelGrid& grid, std::span<const glm::dvec2> pixels, double limit_posts,
                        const Fetch& fetch, std::span<double> posts) {
  TileCursor<BoundaryTile, Fetch> cursor(0, fetch);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    PixelPlace place;
    posts[i] = 0;
    if (!locate(grid, pixels[i].x, pixels[i].y, place)) continue;
    double distance = limit_posts;
    if (!grid.wraps) {
      const double x = place.column + place.fx;
      // The clamped half pixel at the border still counts down to 0.
      const double beyond = grid.period > 0
                                ? pixels[i].x - grid.period * std::round((pixels[i].x - x) / grid.period)
                                : pixels[i].x;
      distance = std::min({distance, beyond + 0.5, grid.width - 0.5 - beyond});
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

}  // namespace mars
