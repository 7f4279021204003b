// Tests of the hand in the view: a cursor that is caught, the cursor and marks of drags.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

class HandsTest : public ExploreWindowTest {
 protected:
  bool is_caught() {
    const bool is_caught = window_->display().has_caught_cursor();
    const int mode = glfwGetInputMode(window_->display().handle(), GLFW_CURSOR);
    EXPECT_EQ(mode == GLFW_CURSOR_DISABLED, is_caught);
    return is_caught;
  }
  void move_by(int dx, int dy) {
    robot_->move_by(dx, dy);
    iterate(2);
  }
  void open_in(explore::MotionMode mode) {
    open();
    window_->session().put({20, 10, 300'000, 0, -10, 0});
    window_->session().set_mode(mode);
    settle();
  }
};

TEST_F(HandsTest, ACaughtCursorLooksAroundWithoutEnd) {
  open();
  window_->session().put({20, 10, 300'000, 0, -10, 0});
  settle();
  key("x");
  EXPECT_FALSE(is_caught()) << "orbit needs the cursor";
  EXPECT_TRUE(window_->state().message_is_error);
  window_->session().set_mode(explore::MotionMode::kFly);
  move(700, 250);
  settle();
  key("x");
  ASSERT_TRUE(is_caught());
  const mars::Pose before = window_->session().pose();
  const double deg_px = 0.1 * window_->session().screen().fov_deg / 50;
  // Farther than the screen is wide.
  double turned_deg = 0;
  for (int n = 0; n < 40; ++n) {
    const double yaw_deg = window_->session().pose().yaw_deg;
    move_by(100, 0);
    turned_deg += std::remainder(window_->session().pose().yaw_deg - yaw_deg, 360.0);
  }
  EXPECT_NEAR(turned_deg, 4000 * deg_px, 1e-6);
  move_by(0, 50);
  EXPECT_NEAR(window_->session().pose().pitch_deg, before.pitch_deg - 50 * deg_px, 1e-6);
  EXPECT_NEAR(window_->session().pose().lon_deg, before.lon_deg, 1e-9);
  EXPECT_NEAR(window_->session().pose().alt_m, before.alt_m, 1e-3);
  // Buttons and panels are out of reach.
  robot_->press();
  move_by(-300, 0);
  robot_->release();
  iterate(2);
  EXPECT_NEAR(window_->session().pose().alt_m, before.alt_m, 1e-3);
  EXPECT_EQ(window_->session().mode(), explore::MotionMode::kFly);

  key("Escape");
  EXPECT_FALSE(is_caught());
  settle();
  const double yaw_deg = window_->session().pose().yaw_deg;
  move_by(50, 10);
  EXPECT_EQ(window_->session().pose().yaw_deg, yaw_deg);
}

TEST_F(HandsTest, ACaughtCursorIsLetGo) {
  open_in(explore::MotionMode::kFly);
  click("mouse");
  EXPECT_TRUE(is_caught());
  key("x");
  EXPECT_FALSE(is_caught());
  key("x");
  EXPECT_TRUE(is_caught());
  robot_->take_focus();
  iterate(3);
  EXPECT_FALSE(is_caught());
  focus();
  EXPECT_FALSE(is_caught());
  // What needs the cursor gets it.
  for (const char* name : {"F1", "Tab", "slash"}) {
    key("x");
    EXPECT_TRUE(is_caught()) << name;
    key(name);
    settle();
    EXPECT_FALSE(is_caught()) << name;
    if (name == std::string("slash")) click(700, 250);
    settle();
  }
  EXPECT_FALSE(ImGui::GetIO().WantTextInput);
  key("x");
  EXPECT_TRUE(is_caught());
  window_->session().set_mode(explore::MotionMode::kOrbit);
  iterate(2);
  EXPECT_FALSE(is_caught());
}

TEST_F(HandsTest, TheWheelSetsTheSpeedWhileTheCursorIsCaught) {
  open_in(explore::MotionMode::kFly);
  const double fov_deg = window_->session().screen().fov_deg;
  const double alt_m = window_->session().pose().alt_m;
  key("x");
  robot_->wheel(2);
  iterate(3);
  EXPECT_NEAR(window_->session().mover().speed(), 1.5625, 1e-9);
  EXPECT_EQ(window_->state().speed, 1);
  key("x");
  window_->session().set_mode(explore::MotionMode::kWalk);
  settle();
  key("x");
  ASSERT_TRUE(is_caught());
  robot_->wheel(-1);
  iterate(3);
  EXPECT_NEAR(window_->state().speed, 0.8, 1e-9);
  EXPECT_EQ(window_->session().screen().fov_deg, fov_deg);
  EXPECT_LT(window_->session().pose().alt_m, alt_m);
}

// How to get the cursor back is told over the view, also without panels.
TEST_F(HandsTest, AWayOutOfTheCaughtCursorIsTold) {
  open_in(explore::MotionMode::kFly);
  key("h");
  for (int n = 0; n < 1000 && !window_->state().message.empty(); ++n) window_->step(0.05);
  settle();
  const auto lower_edge = [&] {
    core::RgbImage image;
    window_->capture(&image);
    for (int n = 0; n < 100 && image.pixels.empty(); ++n) {
      key("Shift_L");
    }
    const auto row = static_cast<std::ptrdiff_t>(image.width) * (image.height - 18);
    return std::vector<base::Rgb>(image.pixels.begin() + row, image.pixels.begin() + row + image.width);
  };
  const std::vector<base::Rgb> free = lower_edge();
  key("x");
  ASSERT_TRUE(is_caught());
  settle();
  EXPECT_NE(lower_edge(), free);
  key("Escape");
  settle();
  EXPECT_EQ(lower_edge(), free);
}

}  // namespace
}  // namespace vpe::window
