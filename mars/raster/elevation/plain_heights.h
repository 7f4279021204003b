// Rasters of heights that lie nowhere on a planet: grids of a plane.
#pragma once

#include <string>
#include <vector>

namespace mars {

inline constexpr int kMostPlainSide_px = 32768;

// Holds heights in metres, row by row, the first row on top; NaN: nodata.
struct PlainHeights {
  int columns = 0;
  int rows = 0;
  std::vector<float> heights_m;
};

// Reads the first band of anything that GDAL opens, without its georeference. Throws SourceError for a raster that cannot
// be read, that is a colour image, or with a side of more than kMostPlainSide_px.
PlainHeights read_plain_heights(const std::string& path);

}  // namespace mars
