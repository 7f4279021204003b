// Grids of boxes in several coordinate systems.
#include "vpe/map/map_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"

namespace {

using vpe::map::grid_of_box;
using vpe::map::MapGrid;
using vpe::map::PlaceBox;

constexpr double kMars_m = 3396190;

// Returns whether every place of a fine net over the box lies within the grid.
bool covers(const mars::MapCrs& crs, const MapGrid& grid, const PlaceBox& box) {
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      std::vector<glm::dvec2> p{{box.west_deg + (box.east_deg - box.west_deg) * i / 40,
                                 box.south_deg + (box.north_deg - box.south_deg) * j / 40}};
      crs.to_map(p);
      if (!std::isfinite(p[0].x)) continue;
      const double width = grid.columns * grid.spacing;
      double x = p[0].x - grid.left;
      if (crs.period() > 0) x -= crs.period() * std::floor((x + 1e-6) / crs.period());
      const double y = grid.top - p[0].y;
      if (x < -1e-5 || x > width + 1e-5 || y < -1e-5 || y > grid.rows * grid.spacing + 1e-5) return false;
    }
  }
  return true;
}

TEST(MapGrid, CoversItsBoxInEverySystem) {
  for (const char* system : {"IAU_2015:49900", "IAU_2015:49910", "IAU_2015:49915", "IAU_2015:49930",
                             "+proj=sinu +lon_0=137 +R=3396190", "+proj=ortho +lat_0=-5 +lon_0=137 +R=3396190",
                             "+proj=aeqd +lat_0=-5 +lon_0=137 +R=3396190"}) {
    const mars::MapCrs crs(system, kMars_m);
    for (const PlaceBox& box :
         {PlaceBox{137, -6, 138.5, -4}, PlaceBox{170, -30, 200, 10}, PlaceBox{-190, 60, -170, 90}}) {
      if (std::string(system).find("ortho") != std::string::npos && box.north_deg == 90) continue;
      const MapGrid grid = grid_of_box(crs, box, 5000);
      EXPECT_TRUE(covers(crs, grid, box)) << system << " from " << box.west_deg;
    }
  }
}

TEST(MapGrid, CrossesTheAntimeridianWithoutATurn) {
  const mars::MapCrs crs("IAU_2015:49910", kMars_m);
  const MapGrid grid = grid_of_box(crs, {170, -10, 190, 10}, 10000);
  const double expected_m = 20 * mars::kRadiansPerDegree * kMars_m;
  EXPECT_NEAR(grid.columns, expected_m / 10000, 2);
  EXPECT_NEAR(grid.rows, expected_m / 10000, 2);
}

TEST(MapGrid, WholePlanetIsATurnWide) {
  const mars::MapCrs degrees("IAU_2015:49900", kMars_m);
  const MapGrid grid = grid_of_box(degrees, {}, kMars_m * mars::kRadiansPerDegree);
  EXPECT_EQ(grid.columns, 360);
  EXPECT_EQ(grid.rows, 180);
  EXPECT_NEAR(grid.left, -180, 1e-9);
  EXPECT_NEAR(grid.top, 90, 1e-9);
}

TEST(MapGrid, NeighboursOfOneSpacingFitEachOther) {
  const mars::MapCrs crs("IAU_2015:49910", kMars_m);
  const MapGrid west = grid_of_box(crs, {10, 0, 11, 1}, 333);
  const MapGrid east = grid_of_box(crs, {11, 0, 12, 1}, 333);
  const double apart = (east.left - west.left) / 333;
  EXPECT_NEAR(apart, std::round(apart), 1e-6);
  EXPECT_EQ(west.top, east.top);
}

TEST(MapGrid, ATinyBoxHasAPixel) {
  const mars::MapCrs crs("IAU_2015:49910", kMars_m);
  const MapGrid grid = grid_of_box(crs, {10, 0, 10.0000001, 0.0000001}, 1000);
  EXPECT_EQ(grid.columns, 1);
  EXPECT_EQ(grid.rows, 1);
}

TEST(MapGrid, RefusesWhatCannotBe) {
  const mars::MapCrs ortho("+proj=ortho +lat_0=0 +lon_0=0 +R=3396190", kMars_m);
  EXPECT_THROW(grid_of_box(ortho, {170, -10, 190, 10}, 1000), std::invalid_argument) << "the far side";
  const mars::MapCrs plain("IAU_2015:49910", kMars_m);
  EXPECT_THROW(grid_of_box(plain, {}, 1), std::invalid_argument) << "21 million columns";
}

TEST(MapGrid, PlacesOfRowsAreThoseOfTheMiddles) {
  const mars::MapCrs degrees("IAU_2015:49900", kMars_m);
  const MapGrid grid{-180, 90, 1, 360, 180};
  const auto places = vpe::map::places_of_rows(degrees, grid, 10, 2);
  ASSERT_EQ(places.size(), 720U);
  EXPECT_NEAR(places[0].x, -179.5, 1e-12);
  EXPECT_NEAR(places[0].y, 79.5, 1e-12);
  EXPECT_NEAR(places[719].x, 179.5, 1e-12);
  EXPECT_NEAR(places[719].y, 78.5, 1e-12);
  EXPECT_EQ(grid.geotransform(), (std::array<double, 6>{-180, 1, 0, 90, 0, -1}));
}

}  // namespace
