// Viewsheds against lines of sight one by one, against GDAL, and against one another on all vector units.
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "tests/map/viewshed_lines.h"
#include "tests/support/support.h"
#include "tests/support/worst.h"
#include "vpe/base/quantile.h"
#include "vpe/map/viewshed/rise.h"
#include "vpe/map/viewshed/viewshed.h"

namespace vpe::map {
namespace {

constexpr double kSphere_m = 3389500;

struct ShedCase {
  const char* name;
  int column = 128;
  int row = 128;
  double observer_m = 2;
  double target_m = 0;
  double radius_m = std::numeric_limits<double>::infinity();
};

ViewshedOptions options_of(const ShedCase& c) {
  ViewshedOptions options;
  options.column = c.column;
  options.row = c.row;
  options.observer_height_m = c.observer_m;
  options.target_height_m = c.target_m;
  options.radius_m = c.radius_m;
  return options;
}

constexpr std::array kShedCases = {
    ShedCase{"middle", 128, 128, 30},
    ShedCase{"low", 128, 128, 2},
    ShedCase{"corner", 0, 256, 60},
    ShedCase{"edge", 256, 100, 60},
    ShedCase{"target", 60, 190, 30, 15},
    ShedCase{"Mars", 128, 128, 60, 0, kSphere_m},
    ShedCase{"moonlet", 100, 90, 60, 0, 60'000},
};

constexpr int kRowsApart = 4;  // of rows that are judged one by one

TEST(ViewshedOracle, LinesOneByOneAgree) {
  for (const double roughness : {0.7, 1.0, 1.4}) {
    const HeightGrid grid = fractal_grid(257, 30, 90, roughness, 11);
    for (const ShedCase& c : kShedCases) {
      const ViewshedOptions options = options_of(c);
      base::ThreadPool pool(2);
      const Viewshed shed = viewshed(grid, options, pool);
      const SightLines lines(grid, options);
      int differ = 0;
      int seen = 0;
      int judged = 0;
      for (int row = 0; row < grid.rows; row += kRowsApart) {
        for (int column = 0; column < grid.columns; ++column, ++judged) {
          const bool sees = lines.sees(column, row);
          const auto at = static_cast<std::size_t>(row) * 257U + static_cast<std::size_t>(column);
          differ += sees != (shed.sights[at] == Sight::seen) ? 1 : 0;
          seen += sees ? 1 : 0;
        }
      }
      EXPECT_GT(seen, judged / 500) << c.name << " " << roughness;
      test_support::record_worst("viewshed: differ from lines one by one", differ, 0.002 * judged, "posts");
    }
  }
}

TEST(ViewshedOracle, NeededHeightsAreThoseOfLinesOneByOne) {
  const HeightGrid grid = fractal_grid(257, 30, 90, 1.0, 12);
  for (const ShedCase& c : kShedCases) {
    const ViewshedOptions options = options_of(c);
    base::ThreadPool pool(2);
    const HeightGrid needed = needed_heights(grid, options, pool);
    const SightLines lines(grid, options);
    std::vector<double> errors_m;
    for (int row = 0; row < grid.rows; row += kRowsApart) {
      for (int column = 0; column < grid.columns; ++column) {
        if (column == options.column && row == options.row) continue;
        // A target of the height that is found has the elevation of the horizon, or more on seen ground.
        const double distance_m = lines.distance_m(column, row);
        const double found_m = double{grid.at(column, row)} + double{needed.at(column, row)};
        const double off = lines.tangent(found_m, distance_m) - lines.horizon(column, row);
        errors_m.push_back((needed.at(column, row) > 0 ? std::abs(off) : std::max(0.0, -off)) * distance_m);
      }
    }
    EXPECT_LT(base::quantile_floor(errors_m, 0.9), 0.01) << c.name;
    test_support::record_worst("viewshed: needed heights, 99th percentile",
                               base::quantile_floor(errors_m, 0.99), 1, "m");
  }
}

struct CloseRaster {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
using ShedRaster = std::unique_ptr<void, CloseRaster>;

std::vector<std::uint8_t> gdal_sights(const HeightGrid& grid, const ViewshedOptions& options) {
  GDALAllRegister();
  GDALDriver* const memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDataset* const raster = memory->Create("", grid.columns, grid.rows, 1, GDT_Float32, nullptr);
  const ShedRaster owner(raster);
  std::array<double, 6> to_map{0, grid.spacing_m, 0, 0, 0, -grid.spacing_m};
  raster->SetGeoTransform(to_map.data());
  std::vector<float> heights_m = grid.heights_m;
  EXPECT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, grid.columns, grid.rows, heights_m.data(),
                                               grid.columns, grid.rows, GDT_Float32, 0, 0, nullptr),
            CE_None);
  const ShedRaster result(GDALViewshedGenerate(
      raster->GetRasterBand(1), "MEM", "", nullptr, (options.column + 0.5) * grid.spacing_m,
      -(options.row + 0.5) * grid.spacing_m, options.observer_height_m, options.target_height_m, 1, 0, 255, -1,
      0, GVM_Edge, 0, nullptr, nullptr, GVOT_NORMAL, nullptr));
  std::vector<std::uint8_t> sights(grid.heights_m.size());
  if (result == nullptr) {
    ADD_FAILURE() << CPLGetLastErrorMsg();
    return sights;
  }
  EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(result.get(), 1), GF_Read, 0, 0, grid.columns, grid.rows,
                         sights.data(), grid.columns, grid.rows, GDT_Byte, 0, 0),
            CE_None);
  return sights;
}

// Counts posts, and who is right where GDAL and viewshed() differ.
struct Verdicts {
  double posts = 0;
  double differ = 0;
  double gdal_right = 0;
};

Verdicts judge(const HeightGrid& grid, const ViewshedOptions& options) {
  base::ThreadPool pool(2);
  const Viewshed shed = viewshed(grid, options, pool);
  const std::vector<std::uint8_t> theirs = gdal_sights(grid, options);
  const SightLines lines(grid, options);
  Verdicts v;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                      static_cast<std::size_t>(column);
      ++v.posts;
      if (static_cast<std::uint8_t>(shed.sights[at]) == theirs[at]) continue;
      ++v.differ;
      if (lines.sees(column, row) == (theirs[at] == 1)) ++v.gdal_right;
    }
  }
  return v;
}

// GDAL takes the horizon of a post from those of the two posts before it, and so smooths it from post to post. Where both
// differ, the lines of sight decide.
void expect_better_than_gdal(const Verdicts& v, const std::string& name) {
  EXPECT_LT(v.differ, 0.03 * v.posts) << name;
  test_support::record_worst("viewshed: where it differs from GDAL, GDAL is right", v.gdal_right,
                             0.1 * v.differ + 2, "posts");
}

TEST(ViewshedGdal, FractalGround) {
  for (const double roughness : {1.0, 1.4}) {
    const HeightGrid grid = fractal_grid(257, 30, 90, roughness, 13);
    for (const ShedCase& c : kShedCases) {
      if (std::isinf(c.radius_m)) expect_better_than_gdal(judge(grid, options_of(c)), c.name);
    }
  }
}

TEST(ViewshedGdal, GroundOfGale) {
  VPE_NEED_SHARED(path, "gale-mola128/gale_megt128.lbl");
  GDALAllRegister();
  GDALDataset* const raster = GDALDataset::Open(path.c_str());
  ASSERT_NE(raster, nullptr);
  const ShedRaster owner(raster);
  HeightGrid grid = flat_grid(raster->GetRasterXSize(), raster->GetRasterYSize(), 463);
  ASSERT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, grid.columns, grid.rows, grid.heights_m.data(),
                                               grid.columns, grid.rows, GDT_Float32, 0, 0, nullptr),
            CE_None);
  for (const auto& [column, row] : {std::pair{448, 448}, std::pair{402, 344}, std::pair{20, 700}}) {
    ShedCase c{"Gale", column, row, 10};
    expect_better_than_gdal(judge(grid, options_of(c)), c.name);
  }
}

TEST(ViewshedOracle, AllVectorUnitsGiveTheSameBits) {
  const HeightGrid grid = fractal_grid(257, 30, 90, 1.0, 14);
  const ViewshedOptions options = options_of(kShedCases[5]);
  base::ThreadPool pool(2);
  const Viewshed shed = viewshed(grid, options, pool);
  const HeightGrid needed = needed_heights(grid, options, pool);
  for (std::int64_t targets = hwy::SupportedTargets() & ~HWY_SCALAR; targets != 0;) {
    targets &= targets - 1;  // without the best one
    hwy::SetSupportedTargetsForTest(targets != 0 ? targets : HWY_SCALAR);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_EQ(viewshed(grid, options, pool).sights, shed.sights) << targets;
    EXPECT_EQ(needed_heights(grid, options, pool).heights_m, needed.heights_m) << targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(Rise, IsThatOfTheClosedForm) {
  test_support::Random random(31);
  for (int trial = 0; trial < 2000; ++trial) {
    RiseView view;
    view.radius_m = random.log_uniform(1e3, 1e8);
    view.observer_m = random.uniform(-0.01, 0.5) * view.radius_m;
    const int across = random.integer(-3000, 3000);
    const int first = random.integer(-3000, 3000);
    const double posts = std::hypot(across, std::max(std::abs(first), std::abs(first + 32)));
    view.spacing_m = random.log_uniform(1e-6, std::numbers::pi / 2) * view.radius_m / (posts + 1);
    view.reach_squared = 1e9;
    std::vector<float> heights_m(33);
    for (float& height : heights_m) height = static_cast<float>(random.uniform(-0.01, 0.02) * view.radius_m);
    std::vector<float> found(33);
    rises(view, heights_m, 1.5F, across, first, found);
    for (int n = 0; n < 33; ++n) {
      if (across == 0 && first + n == 0) continue;
      const auto at = static_cast<std::size_t>(n);
      const double distance_m = view.spacing_m * std::hypot(across, first + n);
      const double a = distance_m / view.radius_m;
      const double height_m = double{heights_m[at]} + 1.5;
      const double wanted_m = distance_m *
                              ((view.radius_m + height_m) * std::cos(a) - (view.radius_m + view.observer_m)) /
                              ((view.radius_m + height_m) * std::sin(a));
      const double size_m =
          std::abs(height_m) + std::abs(view.observer_m) + distance_m * a + std::abs(wanted_m);
      ASSERT_NEAR(double{found[at]}, wanted_m, 1e-6 * size_m) << view.radius_m << " " << a;
    }
    std::vector<float> back = found;
    heights_to_rise(view, heights_m, across, first, back);
    for (int n = 0; n < 33; ++n) {
      const auto at = static_cast<std::size_t>(n);
      const double distance_m = view.spacing_m * std::hypot(across, first + n);
      const double size_m = double{std::abs(heights_m[at])} + std::abs(view.observer_m) +
                            distance_m * distance_m / view.radius_m + double{std::abs(found[at])};
      ASSERT_NEAR(double{back[at]}, 1.5, 1e-6 * size_m + 1e-4) << view.radius_m;
    }
  }
}

TEST(Rise, WhatIsNotKnownHasNone) {
  RiseView view;
  view.radius_m = 1000;
  view.spacing_m = 10;
  view.reach_squared = 25;
  const std::vector<float> heights_m{1, NAN, INFINITY, -2000, -1000, 2e9F, 3, 4};
  std::vector<float> found(8);
  rises(view, heights_m, 0, 3, 0, found);
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 6U, 7U}) EXPECT_EQ(found[n], kNoRise) << n;
  EXPECT_NEAR(found[0], 1 - 0.45, 0.01);
  heights_to_rise(view, heights_m, 3, 0, found);
  EXPECT_EQ(found[0], 0);
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 6U, 7U}) EXPECT_TRUE(std::isnan(found[n])) << n;
  // A tangent that no height has: on a line that leaves the planet's sky.
  std::vector<float> steep{1e6F};
  heights_to_rise(view, std::vector<float>{0}, 3, 0, steep);
  EXPECT_EQ(steep[0], INFINITY);
}

}  // namespace
}  // namespace vpe::map
