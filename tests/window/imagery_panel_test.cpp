// Tests the sliders that stretch imagery in the panel Look.
#include <gtest/gtest.h>

#include "tests/gl/appearance_fixture.h"
#include "tests/window/explore_window_fixture.h"

namespace {

class ImageryPanelTest : public vpe::window::ExploreWindowTest {
 protected:
  static std::shared_ptr<const paging::PlanetFile> imaged() {
    static const test_support::TempDir folder;
    static const auto file = test_support::wavy_planet(folder / "wavy.vpe");
    return file;
  }
  const vpe::core::SettingsValues& values() { return window_->session().settings().values(); }
};

TEST_F(ImageryPanelTest, SlidersStretchTheImagery) {
  planet_ = imaged();
  open(1280, 800);
  settle();
  ASSERT_TRUE(window_->session().set("mode", "textured").empty());
  settle();
  const std::vector<vpe::base::Rgb> before = window_->image().pixels;
  click("Look");
  click("Stretch of imagery");
  const vpe::window::WidgetPlace black = place_of("Black");
  drag({black.x0 + 8, (black.y0 + black.y1) / 2}, {60, 0});
  settle();
  EXPECT_GT(values().image_low, 20);
  EXPECT_EQ(values().image_high, 255);
  EXPECT_NE(window_->image().pixels, before);
  const vpe::window::WidgetPlace gamma = place_of("Gamma");
  drag({(gamma.x0 + gamma.x1) / 3, (gamma.y0 + gamma.y1) / 2}, {30, 0});
  EXPECT_NE(values().image_gamma, 1);
  click("As stored");
  settle();
  EXPECT_EQ(values().image_low, 0);
  EXPECT_EQ(values().image_gamma, 1);
  EXPECT_EQ(window_->image().pixels, before);
}

TEST_F(ImageryPanelTest, TheLightHasThreeChoices) {
  planet_ = imaged();
  open(1280, 800);
  settle();
  ASSERT_TRUE(window_->session().set("mode", "textured").empty());
  settle();
  const std::vector<vpe::base::Rgb> lit = window_->image().pixels;
  click("Look");
  EXPECT_EQ(values().light, vpe::core::Light::kAuto);
  click("Light");
  click("Light=off");
  settle();
  EXPECT_EQ(values().light, vpe::core::Light::kOff);
  EXPECT_NE(window_->image().pixels, lit);
  click("Light");
  click("Light=on");
  settle();
  EXPECT_EQ(values().light, vpe::core::Light::kOn);
  EXPECT_EQ(window_->image().pixels, lit);
  click("Light");
  click("Light=auto");
  settle();
  EXPECT_EQ(values().light, vpe::core::Light::kAuto);
  EXPECT_EQ(window_->image().pixels, lit);
}

TEST_F(ImageryPanelTest, WithoutImageryThereIsNothingToStretch) {
  open();
  settle();
  click("Look");
  settle();
  EXPECT_TRUE(window_->widgets().places().contains("Haze"));
  EXPECT_FALSE(window_->widgets().places().contains("Stretch of imagery"));
}

}  // namespace
