// Rasters that have pixels in few places: which windows have data, and that nothing else is read or planned.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mars/raster/gdal_footprint.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/gdal_tiles.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using mars::Coverage;
using mars::PixelWindow;

bool meet(const PixelWindow& a, const PixelWindow& b) {
  return a.column < b.column + b.columns && b.column < a.column + a.columns && a.row < b.row + b.rows &&
         b.row < a.row + a.rows;
}

// Returns what a mosaic of parts that do not overlap tells about a window.
Coverage coverage_of(const std::vector<PixelWindow>& parts, const PixelWindow& window) {
  long covered = 0;
  for (const PixelWindow& part : parts) {
    if (!meet(part, window)) continue;
    covered += static_cast<long>(std::min(part.column + part.columns, window.column + window.columns) -
                                 std::max(part.column, window.column)) *
               (std::min(part.row + part.rows, window.row + window.rows) - std::max(part.row, window.row));
  }
  if (covered == 0) return Coverage::kNone;
  return covered == static_cast<long>(window.columns) * window.rows ? Coverage::kAll : Coverage::kSome;
}

TEST(DataWindows, HoldAllDataOnce) {
  test_support::Random random(17);
  mars::PixelGrid grid;
  grid.width = 5000;
  grid.height = 3000;
  for (int round = 0; round < 8; ++round) {
    std::vector<PixelWindow> parts;
    for (int n = 0; n < 1 + 2 * round; ++n) {
      const PixelWindow part{random.integer(0, 4600), random.integer(0, 2700), random.integer(1, 399),
                             random.integer(1, 299)};
      if (std::ranges::none_of(parts, [&](const PixelWindow& other) { return meet(part, other); }))
        parts.push_back(part);
    }
    const auto windows =
        mars::data_windows(grid, [&](const PixelWindow& window) { return coverage_of(parts, window); });
    std::vector<char> seen(5000 * 3000, 0);
    for (const PixelWindow& w : windows) {
      for (int row = w.row; row < w.row + w.rows; ++row) {
        for (int column = w.column; column < w.column + w.columns; ++column) {
          ASSERT_EQ(seen[static_cast<std::size_t>(row) * 5000 + static_cast<std::size_t>(column)]++, 0);
        }
      }
    }
    long missed = 0;
    for (const PixelWindow& part : parts) {
      for (int row = part.row; row < part.row + part.rows; ++row) {
        for (int column = part.column; column < part.column + part.columns; ++column)
          missed += seen[static_cast<std::size_t>(row) * 5000 + static_cast<std::size_t>(column)] == 0;
      }
    }
    EXPECT_EQ(missed, 0);
    EXPECT_LT(std::ranges::count(seen, 1), 5000 * 3000 / 2);
  }
}

TEST(DataWindows, FullAndEmptyRasters) {
  for (const int side : {1, 5, 1000}) {
    mars::PixelGrid grid;
    grid.width = grid.height = side;
    const auto full = mars::data_windows(grid, [](const PixelWindow&) { return Coverage::kAll; });
    ASSERT_EQ(full.size(), 1U);
    EXPECT_EQ(full[0].columns, side);
    EXPECT_EQ(full[0].rows, side);
    EXPECT_TRUE(mars::data_windows(grid, [](const PixelWindow&) { return Coverage::kNone; }).empty());
  }
}

// A GeoTIFF of the whole planet with one block, or with all.
std::string sparse_tiff(const test_support::TempDir& folder, bool with_nodata, int first_column = 5000,
                        bool is_sparse = true) {
  GDALAllRegister();
  const std::string path = (folder / (is_sparse ? "sparse.tif" : "full.tif")).string();
  const char* const options[] = {"TILED=YES", is_sparse ? "SPARSE_OK=TRUE" : "SPARSE_OK=FALSE", nullptr};
  auto* made = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), 7200, 3600, 1, GDT_Float32, const_cast<char**>(options));
  OGRSpatialReference crs;
  crs.SetFromUserInput(source_files::kSphere.c_str());
  made->SetSpatialRef(&crs);
  auto to_map = source_files::box(-180, 90, 180, -90, 7200, 3600);
  made->SetGeoTransform(to_map.data());
  if (with_nodata) made->GetRasterBand(1)->SetNoDataValue(-9999);
  std::vector<float> values(100, 1234);
  EXPECT_EQ(made->GetRasterBand(1)->RasterIO(GF_Write, first_column, 1000, 10, 10, values.data(), 10, 10,
                                             GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(made);
  return path;
}

TEST(SparseTiff, IsPlannedAndVisitedWhereItHasBlocks) {
  const test_support::TempDir folder;
  const auto source = mars::open_elevation(sparse_tiff(folder, true));
  const mars::LonLat place{-180 + 5005 * 0.05, 90 - 1005 * 0.05};
  EXPECT_NEAR(source_files::height_at(*source, place), 1234, 1e-3);
  EXPECT_TRUE(std::isfinite(source->spacing_in({mars::direction(place), 0.001})));
  int fine = 0;
  test_support::Random random(5);
  for (int i = 0; i < 1000; ++i) fine += std::isfinite(source->spacing_in({random.direction(), 0.001}));
  EXPECT_LT(fine, 30);  // blocks are enclosed in caps
  std::size_t posts = 0;
  source->visit_posts(5000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    posts += directions.size();
    for (const double h : heights_m) EXPECT_EQ(h, 1234);
  });
  EXPECT_GT(posts, 0U);
}

// Without a nodata value what it lacks are zeros, which are heights.
// Blocks at both ends of the rows, which meet, and one in the middle.
TEST(SparseTiff, HasTheHeightsOfAFullOne) {
  for (const int first_column : {0, 5000, 7190}) {
    const test_support::TempDir folder;
    const auto sparse = mars::open_elevation(sparse_tiff(folder, true, first_column));
    const auto full = mars::open_elevation(sparse_tiff(folder, true, first_column, false));
    test_support::Random random(static_cast<std::uint64_t>(first_column));
    int with_data = 0;
    for (int n = 0; n < 4000; ++n) {
      // Of each other place the pixels are near the data.
      const double spread = n % 2 == 0 ? 12 : 600;
      const mars::LonLat place{-180 + (first_column + 5 + random.uniform(-spread, spread)) * 0.05,
                               90 - (1005 + random.uniform(-spread, spread)) * 0.05};
      const double height_m = source_files::height_at(*sparse, place);
      const double expected_m = source_files::height_at(*full, place);
      if (std::isnan(expected_m)) {
        EXPECT_TRUE(std::isnan(height_m)) << place.lon_deg << " " << place.lat_deg;
      } else {
        EXPECT_EQ(height_m, expected_m) << place.lon_deg << " " << place.lat_deg;
        ++with_data;
      }
    }
    EXPECT_GT(with_data, 100);
  }
}

TEST(SparseTiff, TilesWithoutDataAreNeitherReadNorKept) {
  const test_support::TempDir folder;
  const auto source = mars::open_elevation(sparse_tiff(folder, true));
  source_files::height_at(*source, {-180 + 5005 * 0.05, 90 - 1005 * 0.05});
  const std::size_t bytes = mars::TileStore::common().bytes();
  for (int n = 0; n < 50; ++n)
    EXPECT_TRUE(std::isnan(source_files::height_at(*source, {-170.0 + 3 * n / 2, -40})));
  EXPECT_EQ(mars::TileStore::common().bytes(), bytes);
}

TEST(SparseTiff, WithoutANodataValueIsFull) {
  const test_support::TempDir folder;
  const auto source = mars::open_elevation(sparse_tiff(folder, false));
  EXPECT_EQ(source_files::height_at(*source, {10, 20}), 0);
  EXPECT_TRUE(std::isfinite(source->spacing_in({mars::direction({10, 20}), 0.001})));
}

}  // namespace
