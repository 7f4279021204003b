// Reads a raster whose bands are the levels of a volume: raw volumes with a header, stacks of slices, cubes.
//
// Typical usage:
//   const RasterLevels cube = read_raster_levels("density.vrt", {.side = 2048, .values = 1 << 26});
//   const float lowest_south_west = cube.values[0];
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mars {

struct RasterLevels {
  int width = 0;
  int height = 0;
  int levels = 0;  // bands, from the lowest level to the highest
  std::vector<float>
      values;  // columns run fastest, then rows from the last one (south) to the first, then levels
};

struct RasterLevelsLimits {
  int side = 0;            // along each axis
  std::size_t values = 0;  // of all levels
};

// Reads all bands of any raster that GDAL opens; a map is not needed. Nodata and what is not finite is 0. Throws SourceError for
// files that cannot be read, fewer than 2 columns, rows or bands, and more than the limits, before any value is read.
RasterLevels read_raster_levels(const std::string& path, const RasterLevelsLimits& limits);

}  // namespace mars
