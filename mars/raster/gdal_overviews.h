// Levels of a raster: its full resolution, and the overviews that its file has.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "mars/raster/gdal_grid.h"
#include "mars/raster/gdal_raster.h"
#include "mars/sources/source.h"

namespace mars {

// Describes full resolution or one overview.
struct RasterLevel {
  int overview = -1;  // as GdalRaster::read() takes it
  PixelGrid grid;
  glm::dvec2 scale{1, 1};   // its pixels per pixel of the raster, by column and row
  double factor = 1;        // pixels of the raster per pixel of it
  int block_columns = 256;  // size of the blocks in which it is fetched: that of the file's, if they are tiles
  int block_rows = 256;

  // Return a position among its pixels, and among those of the raster.
  glm::dvec2 from_raster(const glm::dvec2& pixel) const { return (pixel + 0.5) * scale - 0.5; }
  glm::dvec2 to_raster(const glm::dvec2& pixel) const { return (pixel + 0.5) / scale - 0.5; }
};

// Returns full resolution and all overviews of the first band that have its proportions and type, the finest first.
// They are of full resolution alone where a mask or an alpha band marks pixels, since masks need not have overviews.
std::vector<RasterLevel> raster_levels(const GdalRaster& raster, bool is_masked);

// Returns the index of the coarsest level whose pixels are at most sqrt(2) times `factor` pixels of the raster wide.
// Images choose theirs in the same way.
std::size_t level_for(const std::vector<RasterLevel>& levels, double factor);

// Returns a cap around the pixels of a window of a level; all of the sphere where one has no place on it.
Cap cap_of(const Georeference& georeference, const RasterLevel& level, const PixelWindow& window);

}  // namespace mars
