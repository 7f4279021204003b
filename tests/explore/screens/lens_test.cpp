// Tests of lenses: there and back for positions and for images, the image that is needed, what is refused.
#include "vpe/explore/screens/lens.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/screens/lens_table.h"

namespace vpe::explore {
namespace {

ScreenLens strong_lens() {
  ScreenLens lens;
  lens.field_deg = 100;
  lens.distortion = {0.22, 0.24, 0, 0};
  lens.axes_m = 0.0635;
  lens.width_m = 0.0749;
  return lens;
}

ScreenLens barrel_lens() {
  ScreenLens lens;
  lens.field_deg = 60;
  lens.distortion = {-0.08, 0.01, 0, 0};
  return lens;
}

RC_GTEST_PROP(ScreenLensProperty, PositionsGoThereAndBack, ()) {
  ScreenLens lens;
  for (double& k : lens.distortion) k = 0.001 * *rc::gen::inRange(-100, 500);
  const double most_radius = 0.001 * *rc::gen::inRange(200, 2000);
  RC_PRE(is_invertible(lens, most_radius));
  const double r = most_radius * 0.001 * *rc::gen::inRange(0, 1000);
  const double a = 0.001 * *rc::gen::inRange(0, 6283);
  const glm::dvec2 p{r * std::cos(a), r * std::sin(a)};
  const auto back = distorted(lens, undistorted(lens, p), most_radius);
  RC_ASSERT(back.has_value());
  RC_ASSERT(glm::length(*back - p) <= 1e-9);
}

TEST(ScreenLensTest, WithoutDistortionIsAPerspectiveImage) {
  ScreenLens lens;
  lens.field_deg = 90;
  EXPECT_NEAR(lens_focal(lens), 1, 1e-15);
  const LensImage image = lens_image(lens, 800, 600, 0);
  EXPECT_EQ(image.width_px, 802);  // and a pixel on each side
  EXPECT_EQ(image.height_px, 602);
  EXPECT_EQ(image.axis_px, glm::dvec2(401, 301));
  EXPECT_NEAR(image.focal_px, 300, 1e-12);
  EXPECT_EQ(undistorted(lens, {0.3, -0.4}), glm::dvec2(0.3, -0.4));
}

// Written out by hand: 1 + 0.22 * 0.25 + 0.24 * 0.0625 = 1.07 at r = 0.5.
TEST(ScreenLensTest, HasTheFieldAndTheScaleOfItsPolynomial) {
  const ScreenLens lens = strong_lens();
  EXPECT_NEAR(undistorted(lens, {0.5, 0}).x, 0.5 * 1.07, 1e-15);
  const double edge = undistorted(lens, {0, 1}).y;
  EXPECT_NEAR(2 * std::atan(edge / lens_focal(lens)) / mars::kRadiansPerDegree, 100, 1e-12);
}

TEST(ScreenLensTest, TheAxesOfAPairAreTowardsTheNose) {
  const ScreenLens lens = strong_lens();
  const glm::dvec2 left = lens_axis_px(lens, 960, 1080, -1);
  const glm::dvec2 right = lens_axis_px(lens, 960, 1080, 1);
  // Both screens lie side by side, so the axes are axes_m apart.
  const double metres_per_px = lens.width_m / 960;
  EXPECT_NEAR((960 + right.x - left.x) * metres_per_px, lens.axes_m, 1e-12);
  EXPECT_GT(left.x, 480);
  EXPECT_NEAR(left.x + right.x, 960, 1e-9);
  EXPECT_EQ(lens_axis_px(lens, 960, 1080, 0).x, 480);
}

TEST(ScreenLensTest, TheImageCoversTheScreen) {
  for (const ScreenLens& lens : {strong_lens(), barrel_lens()}) {
    for (const int side : {-1, 0, 1}) {
      const LensTable table(lens, 160, 180, side);
      const LensImage& image = table.image();
      glm::vec2 low{1e9F, 1e9F};
      glm::vec2 high{0, 0};
      for (int y = 0; y < 180; ++y)
        for (int x = 0; x < 160; ++x) {
          low = glm::min(low, table.at(x, y));
          high = glm::max(high, table.at(x, y));
        }
      EXPECT_GE(low.x, 0.5F);
      EXPECT_GE(low.y, 0.5F);
      EXPECT_LE(high.x, static_cast<float>(image.width_px) - 0.5F);
      EXPECT_LE(high.y, static_cast<float>(image.height_px) - 0.5F);
      // And is no larger than that asks for.
      EXPECT_LT(low.x, 8.0F);
      EXPECT_GT(high.x, static_cast<float>(image.width_px) - 8.0F);
    }
  }
}

// Draws a round spot and returns its centre of light.
void add_spot(core::RgbImage& image, glm::dvec2 centre) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double d = glm::length(glm::dvec2(x + 0.5, y + 0.5) - centre);
      if (d > 12) continue;
      const auto level = static_cast<std::uint8_t>(std::lround(255 * std::exp(-d * d / 18)));
      image.pixels[static_cast<std::size_t>(y * image.width + x)] = {level, level, level};
    }
}

glm::dvec2 centre_of_light(const core::RgbImage& image, glm::dvec2 about) {
  glm::dvec2 sum{0, 0};
  double light = 0;
  for (int y = static_cast<int>(about.y) - 20; y <= static_cast<int>(about.y) + 20; ++y)
    for (int x = static_cast<int>(about.x) - 20; x <= static_cast<int>(about.x) + 20; ++x) {
      if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
      const double level = image.pixels[static_cast<std::size_t>(y * image.width + x)].g;
      sum += level * glm::dvec2(x + 0.5, y + 0.5);
      light += level;
    }
  return sum / light;
}

TEST(ScreenLensTest, ImagesGoThereAndBackWithinAQuarterOfAPixel) {
  for (const ScreenLens& lens : {strong_lens(), barrel_lens()}) {
    const LensTable table(lens, 480, 540, -1);
    const glm::dvec2 axis = lens_axis_px(lens, 480, 540, -1);
    core::RgbImage plain{table.image().width_px, table.image().height_px, {}};
    plain.pixels.resize(static_cast<std::size_t>(plain.width) * static_cast<std::size_t>(plain.height));
    std::vector<glm::dvec2> spots;
    for (int y = 60; y < 500; y += 95)
      for (int x = 50; x < 450; x += 85) {
        const glm::dvec2 p = (glm::dvec2(x + 0.3, y + 0.6) - axis) / 270.0;
        spots.push_back(table.image().axis_px + undistorted(lens, p) * 270.0);
        add_spot(plain, spots.back());
      }
    const core::RgbImage screen = through_lens(plain, table);
    ASSERT_EQ(screen.width, 480);
    ASSERT_EQ(screen.height, 540);
    const core::RgbImage back = without_lens(screen, lens, -1);
    ASSERT_EQ(back.width, plain.width);
    ASSERT_EQ(back.height, plain.height);
    double most_px = 0;
    for (const glm::dvec2& spot : spots)
      most_px = std::max(most_px, glm::length(centre_of_light(back, spot) - centre_of_light(plain, spot)));
    EXPECT_LE(most_px, 0.25);
    EXPECT_GE(spots.size(), 20U);
    RecordProperty("most_px", std::to_string(most_px));
  }
}

TEST(ScreenLensTest, ACoarserImageStandsForTheWholeOne) {
  const ScreenLens lens = strong_lens();
  const LensTable table(lens, 96, 108, 1);
  core::RgbImage coarse{30, 40, {}};
  coarse.pixels.assign(1200, base::Rgb{10, 20, 30});
  const core::RgbImage screen = through_lens(coarse, table);
  ASSERT_EQ(screen.pixels.size(), 96U * 108U);
  for (const base::Rgb& pixel : screen.pixels) EXPECT_EQ(pixel, (base::Rgb{10, 20, 30}));
  EXPECT_THROW(through_lens({}, table), std::invalid_argument);
  EXPECT_THROW(without_lens({}, lens, 1), std::invalid_argument);
}

TEST(ScreenLensTest, BadLensesAreRefused) {
  const auto refuses = [](const char* word, auto change) {
    ScreenLens lens = strong_lens();
    change(lens);
    const std::string problem = check(lens, 960, 1080, -1);
    EXPECT_NE(problem.find(word), std::string::npos) << word << ": " << problem;
  };
  EXPECT_EQ(check(strong_lens(), 960, 1080, -1), "");
  refuses("field", [](ScreenLens& l) { l.field_deg = 0; });
  refuses("field", [](ScreenLens& l) { l.field_deg = std::numeric_limits<double>::quiet_NaN(); });
  refuses("coefficient", [](ScreenLens& l) { l.distortion[3] = 11; });
  refuses("turns back", [](ScreenLens& l) { l.distortion = {-0.5, 0, 0, 0}; });
  refuses("beside", [](ScreenLens& l) { l.axes_m = 0.9; });
  refuses("needs an image", [](ScreenLens& l) { l.distortion = {9, 9, 9, 9}; });
  EXPECT_FALSE(distorted(strong_lens(), {100, 0}, 1));
  EXPECT_FALSE(distorted(strong_lens(), {std::numeric_limits<double>::quiet_NaN(), 0}, 1));
  EXPECT_EQ(distorted(strong_lens(), {0, 0}, 1), glm::dvec2(0, 0));
  ScreenLens back;
  back.distortion = {-0.5, 0, 0, 0};
  EXPECT_TRUE(is_invertible(back, 0.8));
  EXPECT_FALSE(is_invertible(back, 0.9));
  EXPECT_NEAR(lens_radius(barrel_lens(), 600, 800, 0), 1.25, 1e-15);
}

}  // namespace
}  // namespace vpe::explore
