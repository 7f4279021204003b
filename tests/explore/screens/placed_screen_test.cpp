// Tests of measured screens: what is corrected, what is refused.
#include "vpe/explore/screens/placed_screen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

namespace vpe::explore {
namespace {

PlacedScreen screen_of(glm::dvec3 upper_left, glm::dvec3 upper_right, glm::dvec3 lower_left, int width_px,
                       int height_px) {
  PlacedScreen screen;
  screen.name = "s";
  screen.width_px = width_px;
  screen.height_px = height_px;
  screen.place = ScreenCorners{upper_left, upper_right, lower_left};
  return screen;
}

TEST(PlacedScreen, MeasuredCornersAreMadeExact) {
  // A monitor of 0.5976 x 0.3362 m at 2560 x 1440, a millimetre off.
  const PlacedScreen measured = screen_of({-0.3, 0.2, 0}, {0.2976, 0.2, 0}, {-0.299, -0.1362, 0}, 2560, 1440);
  EXPECT_NE(check(measured), "");
  const FittedScreen fitted = fit(measured);
  ASSERT_EQ(fitted.problem, "");
  EXPECT_EQ(check(fitted.screen), "");
  EXPECT_EQ(fitted.drawn_px, glm::ivec2(2560, 1440));
  const auto& given = std::get<ScreenCorners>(measured.place);
  const auto& made = std::get<ScreenCorners>(fitted.screen.place);
  const double most_m = ScreenLimits::kSquareTolerance * 0.6;
  EXPECT_LT(glm::length(made.upper_left_m - given.upper_left_m), most_m);
  EXPECT_LT(glm::length(made.upper_right_m - given.upper_right_m), most_m);
  EXPECT_LT(glm::length(made.lower_left_m - given.lower_left_m), most_m);
}

TEST(PlacedScreen, PixelsThatAreNotSquareAreDrawnSquare) {
  // A projector of 1280 x 800 on 2 x 1 m: its pixels are 1.25 times as wide as high.
  const FittedScreen fitted = fit(screen_of({0, 1, 0}, {2, 1, 0}, {0, 0, 0}, 1280, 800));
  ASSERT_EQ(fitted.problem, "");
  EXPECT_EQ(fitted.drawn_px, glm::ivec2(1600, 800));
  EXPECT_EQ(check(fitted.screen), "");
  const FittedScreen high = fit(screen_of({0, 1, 0}, {1, 1, 0}, {0, 0, 0}, 1280, 800));
  ASSERT_EQ(high.problem, "");
  EXPECT_EQ(high.drawn_px, glm::ivec2(1280, 1280));
}

TEST(PlacedScreen, BadScreensAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    PlacedScreen screen;
    const char* word;
  } all[] = {
      {screen_of({0, 1, 0}, {1, 1, 0}, {0.1, 0, 0}, 100, 100), "right angle"},
      {screen_of({0, 1, 0}, {0, 1, 0}, {0, 0, 0}, 100, 100), "at least"},
      {screen_of({0, 1, 0}, {1, 1, 0}, {0, nan, 0}, 100, 100), "coordinate"},
      {screen_of({0, 1, 0}, {1e9, 1, 0}, {0, 0, 0}, 100, 100), "coordinate"},
      {screen_of({0, 1, 0}, {1, 1, 0}, {0, 0, 0}, 0, 100), "pixels"},
      {screen_of({0, 1, 0}, {1, 1, 0}, {0, 0, 0}, 100, 100'000), "pixels"},
      {screen_of({0, 1, 0}, {500, 1, 0}, {0, 0, 0}, 100, 100), "square"},
  };
  for (const auto& one : all) {
    const std::string problem = fit(one.screen).problem;
    EXPECT_NE(problem.find(one.word), std::string::npos) << problem;
    EXPECT_NE(check(one.screen), "") << one.word;
  }
}

TEST(PlacedScreen, EyesHaveNames) {
  EXPECT_STREQ(to_string(ScreenEye::kMiddle), "middle");
  EXPECT_STREQ(to_string(ScreenEye::kLeft), "left");
  EXPECT_STREQ(to_string(ScreenEye::kRight), "right");
  EXPECT_STREQ(to_string(ScreenEye::kBoth), "both");
}

}  // namespace
}  // namespace vpe::explore
