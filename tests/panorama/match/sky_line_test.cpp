// The skyline of photographs: steps at known places, and images that have none.
#include "panorama/match/sky_line.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "panorama/match/sky_cells.h"
#include "panorama/match/sky_edge.h"
#include "tests/panorama/match/photo_fixture.h"

namespace match_test {
namespace {

using panorama::find_sky_line;
using panorama::SkyLine;
using panorama::SkyPoint;

// Sky above a level edge, exact shares in the row that it cuts.
RgbImage step_image(int width, int height, double edge_y, int above = 180, int below = 90) {
  RgbImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    const double sky = std::clamp(edge_y - y, 0.0, 1.0);
    const auto level = static_cast<std::uint8_t>(std::lround(sky * above + (1 - sky) * below));
    for (int x = 0; x < width; ++x) image.pixels.push_back({level, level, level});
  }
  return image;
}

RgbImage filled(int width, int height, std::uint8_t level) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, std::vector<vpe::base::Rgb>(count, {level, level, level})};
}

TEST(SkyLine, ALevelEdgeToATenthOfAPixel) {
  for (const double edge : {40.0, 40.25, 40.5, 63.8}) {
    const SkyLine line = find_sky_line(step_image(120, 100, edge));
    ASSERT_EQ(line.points.size(), 120U) << edge;
    for (const SkyPoint& p : line.points) EXPECT_NEAR(p.y_px, edge, 0.1) << p.x_px;
    EXPECT_EQ(line.points.front().x_px, 0.5);
    EXPECT_EQ(line.columns, 120);
  }
}

TEST(SkyLine, TheEdgeOfOneColumn) {
  EXPECT_NEAR(panorama::sky_edge_row(step_image(40, 60, 30.4), 1, 20, 30), 30.4, 0.1);
  EXPECT_NEAR(panorama::sky_edge_row(step_image(40, 60, 30.4), 4, 5, 7), 30.4, 0.3);
}

TEST(SkyLine, CellsOfALargeImageAreMeans) {
  const panorama::SkyCells cells = panorama::sky_cells(filled(5000, 64, 77), 6);
  EXPECT_EQ(cells.size_px, 3);
  EXPECT_EQ(cells.columns, 1666);
  EXPECT_EQ(cells.rows, 21);
  EXPECT_FLOAT_EQ(cells.brightness[cells.at(100, 10)], 77.0F);
  for (const float c : panorama::sky_contrast(cells)) EXPECT_EQ(c, 0.0F);
}

TEST(SkyLine, ASmoothSkyGradientIsNoEdge) {
  RgbImage image{200, 160, {}};
  for (int y = 0; y < 160; ++y) {
    const auto level = static_cast<std::uint8_t>(y < 120 ? 60 + y : 40);
    for (int x = 0; x < 200; ++x) image.pixels.push_back({level, level, level});
  }
  const SkyLine line = find_sky_line(image);
  ASSERT_EQ(line.points.size(), 200U);
  for (const SkyPoint& p : line.points) EXPECT_NEAR(p.y_px, 120, 0.6);
}

TEST(SkyLine, AFaintFarRidgeGoesBeforeAStrongNearOne) {
  Random random(3);
  RgbImage image{200, 160, {}};
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double level = (y < 60 ? 180 : y < 100 ? 165 : 70) + 2 * random.normal();
      const auto grey = static_cast<std::uint8_t>(std::lround(level));
      image.pixels.push_back({grey, grey, grey});
    }
  }
  const SkyLine line = find_sky_line(image);
  ASSERT_GT(line.points.size(), 190U);
  for (const SkyPoint& p : line.points) EXPECT_NEAR(p.y_px, 60, 1.5);
}

TEST(SkyLine, BlackAboveAndAGraticuleAreNoData) {
  RgbImage image = step_image(200, 160, 100);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      auto& pixel = image.pixels[static_cast<std::size_t>(y * 200 + x)];
      if (y < 40 + x / 10) pixel = {0, 0, 0};
      if (y < 40 + x / 10 && (x == 90 || y == 20)) pixel = {255, 255, 255};
    }
  }
  const SkyLine line = find_sky_line(image);
  EXPECT_GT(line.points.size(), 185U);
  for (const SkyPoint& p : line.points) EXPECT_NEAR(p.y_px, 100, 0.3) << p.x_px;
}

TEST(SkyLine, GroundUpToTheUpperEdgeIsLeftOut) {
  RgbImage image = step_image(200, 160, 100);
  for (int y = 0; y < 100; ++y)
    for (int x = 60; x < 100; ++x) image.pixels[static_cast<std::size_t>(y * 200 + x)] = {90, 90, 90};
  const SkyLine line = find_sky_line(image);
  EXPECT_EQ(line.columns_without_edge + line.columns_without_sky + static_cast<int>(line.points.size()),
            line.columns);
  int inside = 0;
  for (const SkyPoint& p : line.points) inside += p.x_px > 62 && p.x_px < 98 ? 1 : 0;
  EXPECT_EQ(inside, 0);
  EXPECT_GT(line.points.size(), 150U);
}

TEST(SkyLine, NothingIsFoundWhereThereIsNone) {
  for (const int level : {0, 128, 255})
    EXPECT_TRUE(find_sky_line(filled(100, 100, static_cast<std::uint8_t>(level))).points.empty()) << level;
}

TEST(SkyLine, BadInput) {
  EXPECT_THROW(find_sky_line(filled(1, 400, 9)), std::invalid_argument);
  EXPECT_THROW(find_sky_line(filled(400, 15, 9)), std::invalid_argument);
  EXPECT_THROW(find_sky_line(RgbImage{}), std::invalid_argument);
  RgbImage torn = filled(100, 100, 9);
  torn.pixels.pop_back();
  EXPECT_THROW(find_sky_line(torn), std::invalid_argument);
  const RgbImage good = filled(100, 100, 9);
  EXPECT_THROW(find_sky_line(good, {-1, 5}), std::invalid_argument);
  EXPECT_THROW(find_sky_line(good, {255, 5}), std::invalid_argument);
  EXPECT_THROW(find_sky_line(good, {6, 1.9}), std::invalid_argument);
  EXPECT_THROW(find_sky_line(good, {6, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace match_test
