#include "mars/raster/gdal_boundary.h"

#include <algorithm>

namespace mars {

BoundaryTile make_boundary_tile(const PixelGrid& grid, const TileId& id, int limit,
                                const std::function<bool(int column, int row)>& has_data) {
  const int side = kTileStride + 2 * limit;
  const auto index = [side](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(column);
  };
  // Pixels beyond the border do not count as nodata: boundary_distances() computes the distance of the border
  // itself.
  std::vector<unsigned char> nodata(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  bool has_nodata = false;
  for (int r = 0; r < side; ++r) {
    const int row = id.row * kTileSide + r - limit;
    if (row < 0 || row >= grid.height) continue;
    for (int c = 0; c < side; ++c) {
      int column = id.column * kTileSide + c - limit;
      if (grid.wraps) column = ((column % grid.width) + grid.width) % grid.width;
      if (column < 0 || column >= grid.width || has_data(column, row)) continue;
      nodata[index(c, r)] = 1;
      has_nodata = true;
    }
  }
  BoundaryTile tile;
  if (!has_nodata) return tile;

  // The distance to nodata of the same column, minimised over the columns, is the exact Euclidean distance.
  const int far = limit + 1;
  std::vector<int> along(nodata.size(), far);
  for (int c = 0; c < side; ++c) {
    int distance = far;
    for (int r = 0; r < side; ++r) {
      distance = nodata[index(c, r)] != 0 ? 0 : std::min(distance + 1, far);
      along[index(c, r)] = distance;
    }
    distance = far;
    for (int r = side - 1; r >= 0; --r) {
      distance = std::min(along[index(c, r)], std::min(distance + 1, far));
      along[index(c, r)] = distance;
    }
  }
  tile.posts.resize(static_cast<std::size_t>(kTileStride) * kTileStride);
  for (int r = 0; r < kTileStride; ++r) {
    for (int c = 0; c < kTileStride; ++c) {
      const int* here = &along[index(c + limit, r + limit)];
      int best = far * far;
      for (int step = 0; step <= limit && step * step < best; ++step) {
        const int nearer = std::min(here[-step], here[step]);
        best = std::min(best, step * step + nearer * nearer);
      }
      tile.posts[static_cast<std::size_t>(r * kTileStride + c)] = static_cast<float>(std::sqrt(best) - 0.5);
    }
  }
  return tile;
}

}  // namespace mars
