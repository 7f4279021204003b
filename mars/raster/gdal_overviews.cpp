#include "mars/raster/gdal_overviews.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include "mars/geodesy/sphere.h"

namespace mars {

namespace {

PixelGrid scaled_grid(const PixelGrid& whole, int width, int height, const glm::dvec2& scale) {
  PixelGrid grid = whole;
  grid.width = width;
  grid.height = height;
  grid.period = whole.period * scale.x;
  grid.first_pole_row = (whole.first_pole_row + 0.5) * scale.y - 0.5;
  grid.last_pole_row = (whole.last_pole_row + 0.5) * scale.y - 0.5;
  return grid;
}

// Sets the size of blocks. Lines and large tiles are fetched in parts.
void take_blocks(GDALRasterBand& band, RasterLevel& level) {
  constexpr int kLeast = 64;
  constexpr int kMost = 1024;
  int columns = 0;
  int rows = 0;
  band.GetBlockSize(&columns, &rows);
  if (columns < kLeast || columns > kMost || rows < kLeast || rows > kMost) return;
  level.block_columns = columns;
  level.block_rows = rows;
}

}  // namespace

std::vector<RasterLevel> raster_levels(const GdalRaster& raster, bool is_masked) {
  const PixelGrid& whole = raster.grid();
  std::vector<RasterLevel> levels{{-1, whole, {1, 1}, 1}};
  const GdalScope scope;
  const auto dataset = raster.acquire();
  GDALRasterBand* band = dataset->GetRasterBand(1);
  take_blocks(*band, levels.front());
  if (is_masked) return levels;
  for (int n = 0; n < band->GetOverviewCount(); ++n) {
    GDALRasterBand* overview = band->GetOverview(n);
    if (overview == nullptr || overview->GetRasterDataType() != band->GetRasterDataType()) continue;
    const int width = overview->GetXSize();
    const int height = overview->GetYSize();
    const glm::dvec2 scale(static_cast<double>(width) / whole.width,
                           static_cast<double>(height) / whole.height);
    const double factor = 1 / std::max(scale.x, scale.y);
    // Sizes are rounded: the proportions differ by a pixel at most.
    if (width < 2 || height < 2 || !(factor > 1.5) || std::abs(width - whole.width / factor) > 1 ||
        std::abs(height - whole.height / factor) > 1)
      continue;
    levels.push_back({n, scaled_grid(whole, width, height, scale), scale, factor});
    take_blocks(*overview, levels.back());
  }
  std::ranges::sort(levels, {}, &RasterLevel::factor);
  return levels;
}

Cap cap_of(const Georeference& georeference, const RasterLevel& level, const PixelWindow& w) {
  constexpr int kCells = 8;  // a side; what bulges between their corners is within the width of one
  std::vector<glm::dvec2> pixels;
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column) {
      const glm::dvec2 share(static_cast<double>(column) / kCells, static_cast<double>(row) / kCells);
      pixels.push_back(
          level.to_raster(glm::dvec2(w.column - 0.5, w.row - 0.5) + share * glm::dvec2(w.columns, w.rows)));
    }
  }
  std::vector<glm::dvec3> directions(pixels.size());
  georeference.to_directions(pixels, directions);
  glm::dvec3 sum(0);
  for (const glm::dvec3& d : directions) sum += d;
  const double length = glm::length(sum);
  if (!(length > 0.5)) return {{1, 0, 0}, kPi};  // NaN too
  const glm::dvec3 centre = sum / length;
  double radius_rad = 0;
  for (const glm::dvec3& d : directions) radius_rad = std::max(radius_rad, angle_between_rad(centre, d));
  return {centre, std::min(kPi, radius_rad * (1 + 2.0 / kCells))};
}

std::size_t level_for(const std::vector<RasterLevel>& levels, double factor) {
  std::size_t found = 0;
  for (std::size_t n = 1; n < levels.size(); ++n) {
    if (levels[n].factor <= std::sqrt(2) * factor) found = n;
  }
  return found;
}

}  // namespace mars
