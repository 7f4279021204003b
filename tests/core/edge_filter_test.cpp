#include "vpe/core/image/edge_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/support/support.h"

namespace {

using test_support::Random;
using vpe::base::Rgb;
using vpe::base::ThreadPool;
using vpe::core::smooth_edges;

constexpr int kWidth = 67;
constexpr int kHeight = 50;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

std::size_t at(int x, int y) { return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x); }

// A slanted plane with any texture has no edge.
TEST(EdgeFilter, LeavesTexturesOfPlanesAlone) {
  Random random(5);
  std::vector<Rgb> colour(kPixels);
  std::vector<float> depth(kPixels);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto grey = static_cast<std::uint8_t>(random.integer(0, 255));
      colour[at(x, y)] = {grey, grey, grey};
      depth[at(x, y)] = 0.3F + 0.004F * static_cast<float>(x) - 0.005F * static_cast<float>(y);
    }
  }
  const std::vector<Rgb> before = colour;
  ThreadPool pool(2);
  smooth_edges(colour, depth, kWidth, kHeight, pool);
  // At the image's edge one neighbour is absent, and the slope itself counts as a bend.
  for (int y = 1; y + 1 < kHeight; ++y) {
    for (int x = 1; x + 1 < kWidth; ++x) ASSERT_EQ(colour[at(x, y)], before[at(x, y)]) << x << " " << y;
  }
}

// A bright half-plane before a dark sky, its outline in steps: closer to its true coverage after than before.
TEST(EdgeFilter, BringsOutlinesCloserToTheirCoverage) {
  for (const double slope : {0.1, 0.25, 0.5, 1.0, -0.3}) {
    std::vector<Rgb> colour(kPixels);
    std::vector<float> depth(kPixels);
    std::vector<double> coverage(kPixels);
    const auto below = [&](double x, double y) { return y > 25 + slope * (x - 33); };
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool ground = below(x + 0.5, y + 0.5);
        const std::uint8_t grey = ground ? 240 : 20;
        colour[at(x, y)] = {grey, grey, grey};
        depth[at(x, y)] = ground ? 0.5F : 0.0F;
        for (int j = 0; j < 8; ++j) {
          for (int i = 0; i < 8; ++i)
            coverage[at(x, y)] += below(x + (i + 0.5) / 8, y + (j + 0.5) / 8) ? 1.0 / 64 : 0;
        }
      }
    }
    const auto error = [&] {
      double sum = 0;
      for (int y = 2; y + 2 < kHeight; ++y) {
        for (int x = 2; x + 2 < kWidth; ++x) {
          const double e = colour[at(x, y)].r - (20 + 220 * coverage[at(x, y)]);
          sum += e * e;
        }
      }
      return std::sqrt(sum);
    };
    const double before = error();
    ThreadPool pool(2);
    smooth_edges(colour, depth, kWidth, kHeight, pool);
    EXPECT_LT(error(), 0.8 * before) << slope;
  }
}

TEST(EdgeFilter, ThreadsDoNotMatterAndSizesAreChecked) {
  Random random(6);
  std::vector<Rgb> colour(kPixels);
  std::vector<float> depth(kPixels);
  for (std::size_t n = 0; n < kPixels; ++n) {
    colour[n] = {static_cast<std::uint8_t>(random.integer(0, 255)),
                 static_cast<std::uint8_t>(random.integer(0, 255)),
                 static_cast<std::uint8_t>(random.integer(0, 255))};
    depth[n] = random.integer(0, 3) == 0 ? 0.0F : static_cast<float>(random.uniform(0.1, 1));
  }
  std::vector<Rgb> many = colour;
  ThreadPool one(1);
  ThreadPool four(4);
  smooth_edges(colour, depth, kWidth, kHeight, one);
  smooth_edges(many, depth, kWidth, kHeight, four);
  EXPECT_EQ(colour, many);
  EXPECT_THROW(smooth_edges(colour, depth, kWidth + 1, kHeight, one), std::invalid_argument);
  std::vector<Rgb> pixel(1);
  const std::vector<float> sky(1);
  smooth_edges(pixel, sky, 1, 1, one);
  EXPECT_EQ(pixel[0], Rgb());
}

}  // namespace
