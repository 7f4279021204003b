#include "vpe/core/image/edge_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
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

// The filter as it is defined, pixel by pixel, in the order of operations that fixes its bits.
struct PlainFilter {
  const std::vector<Rgb>& image;
  int width;
  int height;

  glm::vec3 at(int x, int y) const {
    const Rgb p =
        image[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
    return {p.r, p.g, p.b};
  }
  float luma(int x, int y) const {
    return 0.25F *
           glm::dot(at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1), glm::vec3(0.30F, 0.59F, 0.11F));
  }
  glm::vec3 between(const glm::vec2& p) const {
    const glm::vec2 base = glm::floor(p);
    const glm::vec2 t = p - base;
    const int x = static_cast<int>(base.x);
    const int y = static_cast<int>(base.y);
    return (at(x, y) * (1 - t.x) + at(x + 1, y) * t.x) * (1 - t.y) +
           (at(x, y + 1) * (1 - t.x) + at(x + 1, y + 1) * t.x) * t.y;
  }
  Rgb smoothed(int x, int y) const {
    const float a = luma(x - 1, y - 1), b = luma(x, y - 1), c = luma(x - 1, y), d = luma(x, y);
    glm::vec2 along(a + b - c - d, -(a + c - b - d));
    glm::vec3 mixed = at(x, y);
    if (glm::dot(along, along) >= 0.06F) {
      along /= std::max(std::abs(along.x), std::abs(along.y));
      along /= std::max(std::min(std::abs(along.x), std::abs(along.y)), 0.2F);
      const glm::vec2 here(x, y);
      mixed = mixed * 0.25F + (between(here - 0.25F * along) + between(here + 0.25F * along) +
                               between(here - 0.75F * along) + between(here + 0.75F * along)) *
                                  (0.75F / 4);
    }
    const auto byte = [](float v) {
      return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 255.0F)));
    };
    return {byte(mixed.x), byte(mixed.y), byte(mixed.z)};
  }
  bool is_edge(const std::vector<float>& depth, int x, int y) const {
    const auto value = [&](int i, int j) {
      return depth[static_cast<std::size_t>(std::clamp(j, 0, height - 1) * width +
                                            std::clamp(i, 0, width - 1))];
    };
    const float c = value(x, y), w = value(x - 1, y), e = value(x + 1, y), n = value(x, y - 1),
                s = value(x, y + 1);
    return std::abs(w + e - 2 * c) + std::abs(n + s - 2 * c) >
           vpe::core::kEdgeBend * std::max(std::max(w, e), std::max(n, s));
  }
};

// Images of all sizes have the bits of the definition, at their borders and inside, whatever their contrast.
TEST(EdgeFilter, HasTheBitsOfItsDefinition) {
  Random random(7);
  ThreadPool pool(2);
  int changed = 0;
  for (int n = 0; n < 150; ++n) {
    const int width = random.integer(1, 90);
    const int height = random.integer(1, 60);
    const int contrast = random.integer(0, 2);
    std::vector<Rgb> image(static_cast<std::size_t>(width * height));
    std::vector<float> depth(image.size());
    for (std::size_t k = 0; k < image.size(); ++k) {
      const auto grey = [&] {
        return static_cast<std::uint8_t>(contrast == 0 ? 100 + random.integer(0, 1) : random.integer(0, 255));
      };
      image[k] = {grey(), grey(), grey()};
      if (contrast == 2 && k > image.size() / 2) image[k] = {250, 240, 230};
      depth[k] = random.integer(0, 5) == 0 ? 0.0F : 0.5F;
    }
    std::vector<Rgb> expected = image;
    const PlainFilter plain{image, width, height};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (plain.is_edge(depth, x, y))
          expected[static_cast<std::size_t>(y * width + x)] = plain.smoothed(x, y);
      }
    }
    changed += expected != image ? 1 : 0;
    std::vector<Rgb> out = image;
    smooth_edges(out, depth, width, height, pool);
    ASSERT_EQ(out, expected) << n;
  }
  EXPECT_GT(changed, 50);
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
