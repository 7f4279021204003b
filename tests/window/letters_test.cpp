// Tests of the scale of letters and panels while the window runs.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <string>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

class LettersTest : public ExploreWindowTest {
 protected:
  void with_control(const std::string& name, int times = 1) {
    robot_->key_down("Control_L");
    for (int n = 0; n < times; ++n) key(name);
    robot_->key_up("Control_L");
    settle();
  }
  double scale() { return window_->display().scale(); }
  double width_of(const std::string& label) { return place_of(label).x1 - place_of(label).x0; }

  // Expects that all windows of Dear ImGui are on the screen, and that nothing is cut off at the side panel's edge.
  void expect_on_screen(const std::string& when) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    int windows = 0;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
      const bool is_part = (window->Flags & (ImGuiWindowFlags_ChildWindow | ImGuiWindowFlags_Tooltip)) != 0;
      if (!window->WasActive || window->Hidden || is_part) continue;
      const std::string name = window->Name;
      if (name.starts_with("Debug") || name == "side edge") continue;
      ++windows;
      EXPECT_GE(window->Pos.x, 0) << name << when;
      EXPECT_GE(window->Pos.y, 0) << name << when;
      EXPECT_LE(window->Pos.x + window->Size.x, screen.x + 1) << name << when;
      EXPECT_LE(window->Pos.y + window->Size.y, screen.y + 1) << name << when;
      if (name == "side" || name == "help") {
        const float inside = window->Size.x - 2 * window->WindowPadding.x - window->ScrollbarSizes.x;
        EXPECT_LE(window->ContentSize.x, inside + 1) << name << when;
      }
    }
    EXPECT_GE(windows, 2) << when;
  }
};

TEST(LargestScaleTest, PanelsHaveRoom) {
  for (const auto& [width, height] : {std::pair{640, 400}, {800, 600}, {1280, 720}, {500, 2000}, {4000, 500}}) {
    const double scale = largest_scale(width, height);
    const ExploreLayout l = layout_of({width, height, scale, true, 0, true});
    EXPECT_GE(l.side.width, std::floor(LayoutLimits::kSide_px * scale)) << width << "x" << height;
    EXPECT_GE(height, LayoutLimits::kLeastHeight_px * scale);
    EXPECT_GT(largest_scale(width + 100, height + 100), scale);
  }
}

TEST_F(LettersTest, KeysChangeTheScaleAndItIsKept) {
  double kept = -1;
  extra_.keep_session = [&kept](const ExploreWindow& shown) { kept = shown.state().letters; };
  open(1280, 720);
  const double planet_px = width_of("Planet");
  const int view_px = window_->session().screen().width;
  EXPECT_EQ(view_px, 950);
  with_control("plus", 4);
  EXPECT_NEAR(scale(), 1.45, 1e-9);
  EXPECT_NEAR(window_->state().letters, 1.45, 1e-9);
  EXPECT_NEAR(width_of("Planet"), 1.45 * planet_px, 3);
  EXPECT_EQ(window_->session().screen().width, 1280 - static_cast<int>(std::round(1.45 * 330)));
  const double begun_s = glfwGetTime();
  while (glfwGetTime() < begun_s + 20 && kept < 1.4) iterate(1);
  EXPECT_NEAR(kept, 1.45, 1e-9);
  with_control("minus", 2);
  EXPECT_NEAR(scale(), 1.2, 1e-9);
  with_control("minus", 30);
  EXPECT_EQ(scale(), Display::kSmallestScale);
  with_control("0");
  EXPECT_EQ(scale(), 1);
  EXPECT_EQ(window_->state().letters, 0);
  EXPECT_EQ(width_of("Planet"), planet_px);
  EXPECT_EQ(window_->session().screen().width, view_px);
  window_.reset();

  extra_.letters = 1.5;
  open(1280, 720);
  EXPECT_EQ(scale(), 1.5);
}

TEST_F(LettersTest, StayAtTheirPlaceWhenEyesAreChosen) {
  open(1280, 720);
  settle();
  const WidgetPlace before = place_of("Letters");
  click("##eyes");
  click("##eyes=side by side");
  settle();
  ASSERT_TRUE(window_->state().stereo);
  EXPECT_EQ(place_of("Letters").y0, before.y0);
}

TEST_F(LettersTest, TheSliderChangesTheScaleWhenItIsReleased) {
  open(1280, 720);
  settle();
  const WidgetPlace slider = place_of("Letters");
  const double y = (slider.y0 + slider.y1) / 2;
  move(slider.x0 + 20, y);
  robot_->press();
  iterate(2);
  for (int n = 1; n <= 5; ++n) move(slider.x0 + 20 + 12 * n, y);
  EXPECT_EQ(scale(), 1) << "a slider that is held stays where it is";
  EXPECT_EQ(place_of("Letters").x0, slider.x0);
  robot_->release();
  settle();
  EXPECT_NE(scale(), 1);
  EXPECT_GT(window_->state().letters, 0);
}

TEST_F(LettersTest, EverythingStaysInASmallWindow) {
  extra_.places_file = (folder_ / "places.csv").string();
  open(640, 400);
  for (const int steps : {0, 30, -30}) {
    with_control("0");
    if (steps != 0) with_control(steps > 0 ? "plus" : "minus", std::abs(steps));
    const std::string when = " at " + std::to_string(scale());
    if (steps > 0) {
      EXPECT_NEAR(scale(), 1.7, 1e-9);
    }
    expect_on_screen(when + ", panel closed");
    key("F1");
    settle();
    expect_on_screen(when + ", help");
    key("F1");
    settle();
    // With small letters the panel is beside the view.
    const bool is_narrow = window_->widgets().places().contains("\u2261##side");
    EXPECT_EQ(is_narrow, steps >= 0);
    if (is_narrow) click("\u2261##side");
    settle();
    for (const char* tab : {"View", "Places", "Flight", "Measure", "Draw", "Look", "Detail"}) {
      click(tab);
      settle();
      expect_on_screen(when + ", " + tab);
    }
    if (is_narrow) click("\u2261##side");
    settle();
  }
  // A window that becomes smaller takes letters back, and gives them again.
  with_control("plus", 30);
  glfwSetWindowSize(window_->display().handle(), 440, 300);
  for (int n = 0; n < 200 && scale() > 1.2; ++n) iterate(1);
  settle();
  EXPECT_NEAR(scale(), 1.2, 1e-9);
  EXPECT_NEAR(window_->state().letters, 1.7, 1e-9);
  glfwSetWindowSize(window_->display().handle(), 1280, 720);
  for (int n = 0; n < 200 && scale() < 1.7; ++n) iterate(1);
  EXPECT_NEAR(scale(), 1.7, 1e-9);
}

}  // namespace
}  // namespace vpe::window
