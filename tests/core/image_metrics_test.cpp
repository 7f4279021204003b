// Colour, range and skyline errors against closed forms and injected errors.
#include "vpe/core/image_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/support.h"

namespace vpe::core {
namespace {

constexpr float kSky = std::numeric_limits<float>::infinity();
constexpr int kSide = 48;

std::vector<vpe::base::Rgb> grey(std::size_t pixels, std::uint8_t value) {
  return {pixels, {value, value, value}};
}

// Returns waves of many lengths, so that every window has structure.
std::vector<vpe::base::Rgb> image() {
  std::vector<vpe::base::Rgb> pixels;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double value = 128 + 60 * std::sin(0.7 * x + 0.2 * y) + 40 * std::cos(0.31 * y * x / 10.0);
      const auto level = static_cast<std::uint8_t>(value);
      pixels.push_back({level, static_cast<std::uint8_t>(255 - level), level});
    }
  }
  return pixels;
}

std::vector<vpe::base::Rgb> with_noise(std::vector<vpe::base::Rgb> pixels, int most) {
  test_support::Random random(3);
  for (vpe::base::Rgb& p : pixels) {
    const auto moved = [&](int value) {
      return static_cast<std::uint8_t>(std::clamp(value + random.integer(-most, most), 0, 255));
    };
    p = {moved(p.r), moved(p.g), moved(p.b)};
  }
  return pixels;
}

TEST(ColourError, RmsIsOverPixelsAndChannels) {
  EXPECT_EQ(colour_rms(image(), image()), 0);
  EXPECT_EQ(colour_rms(grey(100, 20), grey(100, 27)), 7);
  // One channel of one pixel in ten off by 30: sqrt(900 / 30).
  std::vector<vpe::base::Rgb> one = grey(10, 100);
  one[3].g = 130;
  EXPECT_NEAR(colour_rms(one, grey(10, 100)), std::sqrt(30.0), 1e-12);
  EXPECT_EQ(colour_rms({}, {}), 0);
  EXPECT_THROW(colour_rms(grey(3, 0), grey(4, 0)), std::invalid_argument);
}

// Uniform whole numbers from -m to m have the variance m (m + 1) / 3.
TEST(ColourError, RmsFindsInjectedNoise) {
  const std::vector<vpe::base::Rgb> middle = grey(200000, 128);
  EXPECT_NEAR(colour_rms(with_noise(middle, 9), middle), std::sqrt(30.0), 0.02);
}

TEST(StructuralSimilarity, IsOneForEqualImagesAndFallsWithNoise) {
  EXPECT_NEAR(structural_similarity(image(), image(), kSide, kSide), 1, 1e-12);
  double before = 1;
  for (const int most : {2, 8, 32, 96}) {
    const double similarity = structural_similarity(image(), with_noise(image(), most), kSide, kSide);
    EXPECT_LT(similarity, before) << most;
    before = similarity;
  }
  EXPECT_LT(before, 0.5);
}

// Without structure only the term of luminance is left: (2 a b + C1) / (a^2 + b^2 + C1).
TEST(StructuralSimilarity, OfPlainImagesIsTheirLuminance) {
  const double c1 = 6.5025;
  const double expected = (2.0 * 50 * 100 + c1) / (50.0 * 50 + 100.0 * 100 + c1);
  EXPECT_NEAR(structural_similarity(grey(11 * 11, 50), grey(11 * 11, 100), 11, 11), expected, 1e-9);
}

// A checkerboard and its negative: the means under the window are both 127.5 but for the weight of one pixel,
// and the covariance is minus the variance.
TEST(StructuralSimilarity, OfANegativeIsNearlyMinusOne) {
  std::vector<vpe::base::Rgb> board;
  std::vector<vpe::base::Rgb> negative;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      const auto value = static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0);
      const auto other = static_cast<std::uint8_t>(255 - value);
      board.push_back({value, value, value});
      negative.push_back({other, other, other});
    }
  }
  const double variance = 127.5 * 127.5;
  const double c2 = 58.5225;
  EXPECT_NEAR(structural_similarity(board, negative, 20, 20), (c2 - 2 * variance) / (2 * variance + c2), 1e-3);
}

TEST(StructuralSimilarity, RefusesWhatHasNoWindow) {
  EXPECT_THROW(structural_similarity(grey(100, 1), grey(100, 1), 10, 10), std::invalid_argument);
  EXPECT_THROW(structural_similarity(grey(132, 1), grey(132, 1), 11, 11), std::invalid_argument);
}

TEST(RangeError, IsRelativeAndLeavesOutSky) {
  std::vector<float> truth(200, 1000.0F);
  std::vector<float> drawn = truth;
  drawn[0] = 1100.0F;
  drawn[1] = 990.0F;
  drawn[2] = kSky;
  truth[3] = kSky;
  const Spread spread = range_error(drawn, truth);
  EXPECT_EQ(spread.count, 198);
  EXPECT_EQ(spread.median, 0);
  EXPECT_NEAR(spread.p99, 0.01, 1e-7);
  EXPECT_NEAR(spread.max, 0.1, 1e-7);
  EXPECT_EQ(range_error({}, {}).count, 0);
}

TEST(Skyline, IsTheTopmostSurfaceOfEachColumn) {
  constexpr int kWidth = 5;
  constexpr int kHeight = 8;
  // Columns: equal; two rows too low; without surface; without sky; only sky.
  const std::vector<int> truth{3, 3, 3, 0, kHeight};
  const std::vector<int> drawn{3, 5, kHeight, 0, kHeight};
  const auto ranges = [&](const std::vector<int>& tops) {
    std::vector<float> range(kWidth * kHeight, kSky);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (y >= tops[static_cast<std::size_t>(x)]) range[static_cast<std::size_t>(y * kWidth + x)] = 10.0F;
      }
    }
    return range;
  };
  const Spread spread = skyline_shift_px(ranges(drawn), ranges(truth), kWidth, kHeight);
  EXPECT_EQ(spread.count, 3);
  EXPECT_EQ(spread.median, 2);
  EXPECT_EQ(spread.max, 5);
  EXPECT_THROW(skyline_shift_px(ranges(drawn), ranges(truth), kWidth, kHeight + 1), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::core
