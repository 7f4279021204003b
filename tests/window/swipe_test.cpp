// The line between two planets in the explore window: what is on its sides, the mouse, the keys.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

// Ground 2 km lower than that of all tests.
std::shared_ptr<const paging::PlanetFile> lower_planet() {
  static const test_support::TempDir folder;
  static const auto file = test_support::build_fake(
      folder / "lower.vpe",
      test_support::FakeElevation([](const glm::dvec3& d) { return test_support::bumpy_height(d) - 2000; }),
      60'000);
  return file;
}

class SwipeTest : public ExploreWindowTest {
 protected:
  void open_pair() {
    planet_ = planet()->compared_with(lower_planet());
    open();
    window_->session().put({20, 10, 60'000, 0, -60, 0});
    settle();
  }
  core::RgbImage captured() {
    core::RgbImage image;
    window_->capture(&image);
    for (int n = 0; n < 100 && image.pixels.empty(); ++n) key("Shift_L");
    window_->capture(nullptr);
    EXPECT_FALSE(image.pixels.empty());
    return image;
  }
  // Expects the columns from..to of two images to be equal, above the names of the sides.
  static void expect_same(const core::RgbImage& a, const core::RgbImage& b, int from, int to) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    int off = 0;
    for (int y = 0; y < a.height - 60; ++y) {
      for (int x = from; x < to; ++x) {
        const auto n = static_cast<std::size_t>(y * a.width + x);
        off = std::max({off, std::abs(a.pixels[n].r - b.pixels[n].r), std::abs(a.pixels[n].g - b.pixels[n].g),
                        std::abs(a.pixels[n].b - b.pixels[n].b)});
      }
    }
    EXPECT_LE(off, 1) << from << " to " << to;
  }
};

TEST_F(SwipeTest, EachPlanetHasItsSide) {
  open_pair();
  key("h");  // no panels over the view
  settle();
  const DrawnImage& drawn = *window_->drawn();
  ASSERT_TRUE(drawn.request.with_earlier);
  ASSERT_EQ(drawn.earlier.width, 960);
  const core::RgbImage shown = captured();
  expect_same(shown, drawn.earlier, 0, 465);
  expect_same(shown, window_->image(), 495, 960);
  EXPECT_NE(drawn.earlier.pixels, window_->image().pixels);

  // The left side is what a painter of the earlier planet alone draws with the same request.
  app::Common common;
  common.memory_mb = 256;
  app::WindowPainter painter(lower_planet(), common);
  ImageRequest request = drawn.request;
  request.with_earlier = false;
  request.margin_px = {0, 0};
  request.draw.paging.wait = true;
  EXPECT_EQ(painter.paint(request).image.pixels, drawn.earlier.pixels);
}

TEST_F(SwipeTest, TheMouseDragsIt) {
  open_pair();
  const mars::Pose before = window_->session().pose();
  ASSERT_TRUE(window_->swipe_line().is_on());
  const double y = 300;
  // The side panel has the left of the window.
  const double width = window_->session().screen().width;
  const double x = window_->swipe_line().x_px({960 - width, 0, width, 540});
  move(x, y);
  robot_->press();
  iterate(3);
  move(x + 100, y);
  robot_->release();
  iterate(3);
  EXPECT_NEAR(window_->swipe_line().share(), 0.5 + 100 / width, 2 / width);
  const mars::Pose after = window_->session().pose();
  EXPECT_EQ(before.lon_deg, after.lon_deg);
  EXPECT_EQ(before.lat_deg, after.lat_deg);
  EXPECT_EQ(before.yaw_deg, after.yaw_deg);
  // Beside the line the mouse moves the ground as ever.
  move(x - 60, y);
  robot_->press();
  iterate(3);
  move(x - 30, y + 30);
  robot_->release();
  iterate(3);
  EXPECT_NE(window_->session().pose().lat_deg, after.lat_deg);
  EXPECT_NEAR(window_->swipe_line().share(), 0.5 + 100 / width, 2 / width);
}

TEST_F(SwipeTest, KeysMoveAndHideIt) {
  open_pair();
  key("bracketright");
  EXPECT_NEAR(window_->swipe_line().share(), 0.5 + SwipeLine::kStep, 1e-9);
  key("bracketleft");
  key("bracketleft");
  EXPECT_NEAR(window_->swipe_line().share(), 0.5 - SwipeLine::kStep, 1e-9);
  key("b");
  EXPECT_FALSE(window_->swipe_line().is_on());
  settle();
  EXPECT_FALSE(window_->drawn()->request.with_earlier);
  EXPECT_TRUE(window_->drawn()->earlier.pixels.empty());
  click("swipe");
  EXPECT_TRUE(window_->swipe_line().is_on());
  settle();
  EXPECT_FALSE(window_->drawn()->earlier.pixels.empty());
}

TEST_F(SwipeTest, DifferencesAreThoseOfThePlanet) {
  planet_ = planet()->compared_with(lower_planet());
  for (const char* assignment : {"mode=unlit", "colour=difference", "palette.low=-2000", "palette.high=2000"})
    ASSERT_EQ(extra_.session.settings.assign(assignment), "");
  open();
  window_->session().put({20, 10, 300'000, 0, -90, 0});
  settle();
  core::Appearance appearance;
  appearance.colour = core::Colour::kDifference;
  appearance.palette_low = -2000;
  appearance.palette_high = 2000;
  const core::ColourScale scale(appearance);
  const auto expect_colour = [](const core::RgbImage& image, const glm::dvec3& colour) {
    const base::Rgb pixel =
        image.pixels[static_cast<std::size_t>(image.height / 2 * image.width + image.width / 2)];
    EXPECT_NEAR(pixel.r, colour.x, 1);
    EXPECT_NEAR(pixel.g, colour.y, 1);
    EXPECT_NEAR(pixel.b, colour.z, 1);
  };
  expect_colour(window_->image(), scale(2000));
  expect_colour(window_->drawn()->earlier, scale(0));  // above itself
}

TEST_F(SwipeTest, NeedsAnEarlierPlanet) {
  open();
  EXPECT_FALSE(window_->swipe_line().is_on());
  EXPECT_NE(window_->act({explore::ActionKind::kSwipe}), "");
  EXPECT_FALSE(window_->swipe_line().is_on());
  EXPECT_FALSE(window_->widgets().places().contains("swipe"));
}

}  // namespace
}  // namespace vpe::window
