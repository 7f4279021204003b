// Interpolated places of pixels against those of PROJ.
#include "vpe/map/place_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "mars/geodesy/sphere.h"

namespace {

using vpe::map::MapGrid;
using vpe::map::PixelRect;
using vpe::map::PlaceBlock;

constexpr double kMars_m = mars::kMarsRadius_m;

// Returns the largest angle between directions of a block and those of its places; a negative number where PROJ has to be
// asked.
double worst_angle(const mars::MapCrs& crs, const MapGrid& grid, const PixelRect& rect) {
  const auto block = PlaceBlock::fit(crs, grid, rect);
  if (!block) return -1;
  double worst = 0;
  vpe::map::DirectionLine line;
  for (int row = 0; row < rect.rows; ++row) {
    block->directions(row, line);
    std::vector<glm::dvec2> places;
    for (int column = 0; column < rect.columns; ++column)
      places.push_back(grid.middle(rect.column + column, rect.row + row));
    crs.to_place(places);
    for (int column = 0; column < rect.columns; ++column) {
      const glm::dvec2& p = places[static_cast<std::size_t>(column)];
      worst = std::max(worst, glm::length(line.at(column) - mars::direction({p.x, p.y})));
    }
  }
  return worst;
}

// A map of 640 x 640 pixels about a place.
MapGrid grid_about(const mars::MapCrs& crs, glm::dvec2 place, double spacing_m) {
  std::vector<glm::dvec2> middle{place};
  crs.to_map(middle);
  const double spacing = spacing_m / crs.unit_m();
  return {middle[0].x - 320 * spacing, middle[0].y + 320 * spacing, spacing, 640, 640};
}

TEST(PlaceBlock, IsWithinItsBoundAtEveryPixel) {
  struct Map {
    const char* system;
    glm::dvec2 place;
    double spacing_m;
  };
  for (const Map& map :
       {Map{"IAU_2015:49900", {137, -5}, 100}, Map{"IAU_2015:49910", {179, 40}, 900},
        Map{"IAU_2015:49930", {0, 90}, 500}, Map{"IAU_2015:49935", {120, -80}, 5},
        Map{"IAU_2015:49912", {-20, 30}, 300}, Map{"+proj=lcc +lat_1=20 +lat_2=50 +R=3396190", {5, 35}, 200},
        Map{"+proj=laea +lat_0=-4.5 +lon_0=137 +R=3396190", {137, -5}, 1},
        Map{"+proj=sinu +lon_0=120 +R=3396190", {100, 20}, 250},
        Map{"+proj=merc +R=3396190", {-170, 60}, 250}}) {
    const mars::MapCrs crs(map.system, kMars_m);
    const MapGrid grid = grid_about(crs, map.place, map.spacing_m);
    const int side = vpe::map::place_block_side(crs, grid, kMars_m);
    ASSERT_EQ(side, vpe::map::kMostPlaceBlockSide) << map.system;
    int fitted = 0;
    for (int n = 0; n < 10; n += 3) {
      const double worst = worst_angle(crs, grid, {n * side, (9 - n) * side, side, side});
      fitted += worst >= 0 ? 1 : 0;
      EXPECT_LE(worst, vpe::map::kPlaceBlockError_rad) << map.system;
    }
    EXPECT_EQ(fitted, 4) << map.system;
    // The edge of a map has what is left.
    EXPECT_LE(worst_angle(crs, grid, {0, 0, 17, 64}), vpe::map::kPlaceBlockError_rad);
  }
}

TEST(PlaceBlock, IsNotThereAtRimsAndWherePixelsAreFew) {
  const mars::MapCrs crs("+proj=ortho +lat_0=20 +lon_0=40 +R=3396190", kMars_m);
  const double spacing = 1000;
  const MapGrid grid{-3.4e6, 3.4e6, spacing, 6800, 6800};
  const auto fits = [&](double x, double y) {
    const int column = static_cast<int>((x + 3.4e6) / spacing);
    const int row = static_cast<int>((3.4e6 - y) / spacing);
    return PlaceBlock::fit(crs, grid, {column, row, 64, 64}).has_value();
  };
  EXPECT_TRUE(fits(0, 0));
  EXPECT_FALSE(fits(kMars_m - 40000, 0)) << "the rim goes through the block";
  EXPECT_FALSE(fits(0.71 * kMars_m, 0.71 * kMars_m)) << "off the planet";
  EXPECT_FALSE(PlaceBlock::fit(crs, grid, {3400, 3400, 15, 16}).has_value());
  // A block of a sinusoidal map whose corner alone is off the planet.
  const mars::MapCrs sinusoidal("+proj=sinu +R=3396190", kMars_m);
  std::vector<glm::dvec2> rim{{180, 30}};
  sinusoidal.to_map(rim);
  const MapGrid corner{rim[0].x - 31000, rim[0].y + 1000, 500, 64, 64};
  EXPECT_FALSE(PlaceBlock::fit(sinusoidal, corner, {0, 0, 64, 64}).has_value());
}

TEST(PlaceBlock, SidesSuitThePixels) {
  const mars::MapCrs crs("IAU_2015:49910", kMars_m);
  const auto side = [&](double spacing_m) {
    return vpe::map::place_block_side(crs, {0, 0, spacing_m, 1000, 1000}, kMars_m);
  };
  EXPECT_EQ(side(1), 64);
  EXPECT_EQ(side(7000), 64);
  EXPECT_EQ(side(14818), 32);
  EXPECT_EQ(side(30000), 16);
  EXPECT_EQ(side(60000), 0);
}

}  // namespace
