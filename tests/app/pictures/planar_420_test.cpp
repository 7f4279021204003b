// Luma and chroma of frames against the formula of BT.709 in double, on each instruction set.
#include "vpe/app/film/planar_420.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/support/worst.h"

namespace vpe::app {
namespace {

struct Picture {
  int width;
  int height;
  std::vector<base::Rgb> pixels;
};

Picture noise(int width, int height, std::uint32_t seed) {
  std::mt19937 random(seed);
  Picture picture{width, height, {}};
  for (int n = 0; n < width * height; ++n) {
    // Extremes beside everything else.
    const auto channel = [&] {
      const std::uint32_t value = random() % 512;
      return static_cast<std::uint8_t>(value < 256 ? value : value % 2 * 255);
    };
    picture.pixels.push_back({channel(), channel(), channel()});
  }
  return picture;
}

struct Exact {
  double luma, u, v;
};

Exact exact(double red, double green, double blue) {
  const double luma = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  return {16 + luma * 219 / 255, 128 + (blue - luma) / 1.8556 * 224 / 255,
          128 + (red - luma) / 1.5748 * 224 / 255};
}

// Returns how far values are from the formula.
double worst_of(const Picture& p, const std::vector<std::uint8_t>& planes) {
  const auto pixels = static_cast<std::size_t>(p.width * p.height);
  EXPECT_EQ(planes.size(), pixels * 3 / 2);
  double worst = 0;
  const auto compare = [&](std::size_t at, double wanted) {
    worst = std::max(worst, std::abs(planes.at(at) - wanted));
  };
  for (std::size_t n = 0; n < pixels; ++n) compare(n, exact(p.pixels[n].r, p.pixels[n].g, p.pixels[n].b).luma);
  for (int y = 0; y < p.height / 2; ++y) {
    for (int x = 0; x < p.width / 2; ++x) {
      double red = 0, green = 0, blue = 0;
      for (int k = 0; k < 4; ++k) {
        const base::Rgb& c = p.pixels[static_cast<std::size_t>((2 * y + k / 2) * p.width + 2 * x + k % 2)];
        red += c.r / 4.0;
        green += c.g / 4.0;
        blue += c.b / 4.0;
      }
      const auto at = static_cast<std::size_t>(y * (p.width / 2) + x);
      compare(pixels + at, exact(red, green, blue).u);
      compare(pixels + pixels / 4 + at, exact(red, green, blue).v);
    }
  }
  return worst;
}

TEST(Planar420, IsThatOfTheFormulaOnEachInstructionSet) {
  double worst = 0;
  for (const int width : {2, 6, 30, 64, 66, 130, 1280}) {
    for (const int height : {2, 6}) {
      const Picture picture = noise(width, height, static_cast<std::uint32_t>(width + height));
      std::vector<std::uint8_t> planes;
      to_planar_420(picture.pixels, width, height, planes);
      worst = std::max(worst, worst_of(picture, planes));
      for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
        const std::int64_t target = left & -left;
        hwy::SetSupportedTargetsForTest(target);
        std::vector<std::uint8_t> others;
        to_planar_420(picture.pixels, width, height, others);
        EXPECT_EQ(others, planes) << width << "x" << height << ", " << hwy::TargetName(target);
      }
      hwy::SetSupportedTargetsForTest(0);
    }
  }
  test_support::record_worst("planes of video against the formula", worst, 0.52, "of 255");
  EXPECT_LE(worst, 0.52);
}

TEST(Planar420, GreysHaveNoChroma) {
  std::vector<base::Rgb> pixels;
  for (int n = 0; n < 256; ++n) {
    const auto grey = static_cast<std::uint8_t>(n);
    pixels.insert(pixels.end(), 4, {grey, grey, grey});
  }
  std::vector<std::uint8_t> planes;
  to_planar_420(pixels, 2, 512, planes);
  EXPECT_EQ(planes.front(), 16);
  EXPECT_EQ(planes[1023], 235);
  for (std::size_t n = 1024; n < planes.size(); ++n) EXPECT_EQ(planes[n], 128) << n;
}

TEST(Planar420, OddSidesAreRefused) {
  std::vector<std::uint8_t> planes;
  EXPECT_THROW(to_planar_420(std::vector<base::Rgb>(6), 3, 2, planes), std::invalid_argument);
  EXPECT_THROW(to_planar_420(std::vector<base::Rgb>(6), 2, 3, planes), std::invalid_argument);
  EXPECT_THROW(to_planar_420(std::vector<base::Rgb>(6), 2, 2, planes), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::app
