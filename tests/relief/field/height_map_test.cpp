// Height maps: values, borders, bounds, tapering, bad input.
#include "relief/field/height_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "relief/field/interval_algebra.h"
#include "tests/relief/samples.h"

namespace relief {
namespace {

constexpr Interpolation kBoth[] = {Interpolation::kBilinear, Interpolation::kBicubic};

TEST(ReliefHeightMap, GoesThroughItsPosts) {
  for (const Interpolation interpolation : kBoth) {
    std::vector<float> posts;
    for (int n = 0; n < 15; ++n) posts.push_back(static_cast<float>(n * n % 7));
    const HeightMap map({5, 3, 10, 20, 2, 3}, posts, interpolation);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 5; ++i)
        EXPECT_NEAR(map.height_m(10 + 2 * i, 20 + 3 * j), posts[static_cast<std::size_t>(5 * j + i)], 1e-14);
    EXPECT_EQ(map.support().x1_m, 18);
    EXPECT_EQ(map.support().y1_m, 26);
    EXPECT_EQ(map.height_m(18.001, 21), 0);
    EXPECT_EQ(map.height_m(9.999, 21), 0);
    EXPECT_EQ(map.gradient(9.999, 21), glm::dvec2(0, 0));
  }
}

TEST(ReliefHeightMap, KeepsAPlaneUpToTheBorder) {
  for (const Interpolation interpolation : kBoth) {
    std::vector<float> posts;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 6; ++i) posts.push_back(static_cast<float>(3 + 2 * i - j));
    const HeightMap map({6, 4, 0, 0, 1, 1}, posts, interpolation);
    samples::Random random(15);
    for (int n = 0; n < 300; ++n) {
      const double x = random.in(0.0, 5.0);
      const double y = random.in(0.0, 3.0);
      EXPECT_NEAR(map.height_m(x, y), 3 + 2 * x - y, 1e-13);
      EXPECT_NEAR(map.gradient(x, y).x, 2, 1e-13);
      EXPECT_NEAR(map.gradient(x, y).y, -1, 1e-13);
    }
    EXPECT_NEAR(map.facet_deviation_m(), 0, 1e-13);
  }
}

TEST(ReliefHeightMap, NeighbouringCellsAgreeAtTheirBorder) {
  const auto linear = samples::rough_map(12, 9, 3, Interpolation::kBilinear, 16);
  const auto cubic = samples::rough_map(12, 9, 3, Interpolation::kBicubic, 16);
  samples::Random random(17);
  for (int n = 0; n < 300; ++n) {
    const int i = random.in(0, 9);
    const int j = random.in(0, 6);
    const double t = random.in(0.0, 1.0);
    for (const auto& map : {linear, cubic}) {
      EXPECT_NEAR(map->patch(i, j).height_m(1, t), map->patch(i + 1, j).height_m(0, t), 1e-14);
      EXPECT_NEAR(map->patch(i, j).height_m(t, 1), map->patch(i, j + 1).height_m(t, 0), 1e-14);
    }
    // Only bicubic ones have the same slope.
    EXPECT_NEAR(cubic->patch(i, j).gradient(1, t).x, cubic->patch(i + 1, j).gradient(0, t).x, 1e-13);
    EXPECT_NEAR(cubic->patch(i, j).gradient(t, 1).y, cubic->patch(i, j + 1).gradient(t, 0).y, 1e-13);
  }
}

TEST(ReliefHeightMap, BoundsHoldTheHeightsOfARectangle) {
  for (const Interpolation interpolation : kBoth) {
    const auto map = samples::rough_map(33, 18, 5, interpolation, 18, 0.7, 1.3);
    samples::Random random(19);
    for (int n = 0; n < 3000; ++n) {
      const double size = std::pow(10.0, random.in(-7.0, 1.5));
      const double x0 = random.in(-14.0, 13.0);
      const double y0 = random.in(-14.0, 13.0);
      const Rect rect{x0, y0, x0 + size, y0 + size * random.in(0.1, 1.0)};
      const Interval fine = map->bounds_m(rect);
      const Interval coarse = map->coarse_bounds_m(rect);
      for (int m = 0; m < 10; ++m) {
        const double height = map->height_m(random.in(rect.x0_m, rect.x1_m), random.in(rect.y0_m, rect.y1_m));
        EXPECT_TRUE(holds(widened(fine, 1e-13), height)) << size;
        EXPECT_TRUE(holds(coarse, height)) << size;
      }
      const Rect& support = map->support();
      const bool is_within = rect.x0_m > support.x0_m && rect.x1_m < support.x1_m && rect.y0_m > support.y0_m &&
                             rect.y1_m < support.y1_m;
      if (is_within) {
        EXPECT_LE(width(fine), 200 * size + 1e-6) << size;
      }
    }
    EXPECT_EQ(map->bounds_m({100, 0, 101, 1}).high, 0);
    const Interval all = map->bounds_m({-1e300, -1e300, 1e300, 1e300});
    EXPECT_LT(all.low, -3);
    EXPECT_GT(all.high, 3);
  }
}

TEST(ReliefHeightMap, StatesTheLargestFacetDeviation) {
  for (const Interpolation interpolation : kBoth) {
    const auto map = samples::rough_map(9, 7, 3, interpolation, 20);
    double largest = 0;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(map->facet_deviation_m(i, j), map->patch(i, j).facet_deviation_m());
        largest = std::max(largest, map->facet_deviation_m(i, j));
      }
    EXPECT_EQ(map->facet_deviation_m(), largest);
  }
}

TEST(ReliefHeightMap, TaperedPostsFallToZeroAtTheBorder) {
  const std::vector<float> posts(10 * 8, 4.0F);
  const std::vector<float> found = tapered(posts, 10, 8, 3);
  const auto at = [&](int i, int j) { return found[static_cast<std::size_t>(10 * j + i)]; };
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(at(i, 0), 0);
    EXPECT_EQ(at(i, 7), 0);
  }
  EXPECT_EQ(at(0, 4), 0);
  EXPECT_EQ(at(4, 4), 4);
  EXPECT_GT(at(1, 4), 0);
  EXPECT_LT(at(1, 4), at(2, 4));
  EXPECT_THROW(tapered(posts, 9, 8, 3), std::invalid_argument);
  EXPECT_THROW(tapered(posts, 10, 8, 0), std::invalid_argument);
}

TEST(ReliefHeightMap, BadMapsAreRefused) {
  const auto make = [](const MapLayout& layout, std::vector<float> posts) {
    return HeightMap(layout, std::move(posts), Interpolation::kBicubic);
  };
  EXPECT_THROW(make({1, 2, 0, 0, 1, 1}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(make({2, 2, 0, 0, 1, 1}, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(make({40000, 2, 0, 0, 1, 1}, std::vector<float>(80000)), std::invalid_argument);
  EXPECT_THROW(make({2, 2, 0, 0, 0, 1}, {1, 2, 3, 4}), std::invalid_argument);
  EXPECT_THROW(make({2, 2, std::nan(""), 0, 1, 1}, {1, 2, 3, 4}), std::invalid_argument);
  EXPECT_THROW(make({2, 2, 0, 0, 1, 1}, {1, 2, 3, std::numeric_limits<float>::quiet_NaN()}),
               std::invalid_argument);
  EXPECT_NO_THROW(make({2, 2, 0, 0, 1, 1}, {1, 2, 3, 4}));
}

}  // namespace
}  // namespace relief
