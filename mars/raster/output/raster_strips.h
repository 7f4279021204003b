// Rasters made in strips of rows, by several runs or processes, and joined at the end.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "mars/raster/output/raster_writer.h"

namespace mars {

// Holds a strip of a raster that is to be joined.
struct RasterStrip {
  std::filesystem::path path;
  int rows = 0;
};

// Writes a strip: all rows of all bands of `info`, which describes the strip alone. channels[band] holds its rows. The
// file appears under its name when it is complete. Throws SourceError and base::FileError.
void write_strip(const std::filesystem::path& path, const RasterInfo& info,
                 std::span<const std::vector<float>> channels);

// Joins strips from north to south to a cloud-optimised GeoTIFF, which appears under its name when it is complete.
// `info` describes all of it. Throws SourceError and base::FileError.
void join_strips(const std::filesystem::path& path, const RasterInfo& info,
                 std::span<const RasterStrip> strips);

}  // namespace mars
