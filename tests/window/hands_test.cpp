// Tests of the hand in the view: a cursor that is caught, the cursor and marks of drags.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/window/explore_window_fixture.h"
#include "vpe/window/marks/pivot_mark.h"
#include "vpe/window/ui/hand_cursor.h"

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
  // Returns the pixels of the window.
  core::RgbImage captured() {
    core::RgbImage image;
    window_->capture(&image);
    for (int n = 0; n < 100 && image.pixels.empty(); ++n) key("Shift_L");
    window_->capture(nullptr);
    EXPECT_FALSE(image.pixels.empty());
    return image;
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
  key("F6");  // into the panels
  settle();
  EXPECT_FALSE(is_caught());
  key("Escape");
  settle();
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
  settle();
  const auto lower_edge = [&] {
    const core::RgbImage image = captured();
    const auto row = static_cast<std::ptrdiff_t>(image.width) * (image.height - 18);
    return std::vector<base::Rgb>(image.pixels.begin() + row, image.pixels.begin() + row + image.width);
  };
  const std::vector<base::Rgb> free = lower_edge();
  const mars::Pose before = window_->session().pose();
  key("x");
  ASSERT_TRUE(is_caught());
  settle();
  EXPECT_EQ(window_->session().pose().pitch_deg, before.pitch_deg) << "to catch the cursor turns nothing";
  EXPECT_EQ(window_->session().pose().yaw_deg, before.yaw_deg);
  EXPECT_NE(lower_edge(), free);
  key("Escape");
  settle();
  EXPECT_EQ(lower_edge(), free);
}

// Returns a cursor's image as the X server has it.
std::vector<std::uint32_t> screen_pixels(const CursorImage& image) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t n = 0; n < image.rgba.size(); n += 4) {
    const std::uint32_t alpha = image.rgba[n + 3];
    const std::uint32_t grey = alpha == 0 ? 0 : image.rgba[n];
    pixels.push_back(alpha << 24U | grey << 16U | grey << 8U | grey);
  }
  return pixels;
}

TEST(HandCursorTest, IsAClosedOutlineOfItsSize) {
  for (const int factor : {1, 2, 4}) {
    const CursorImage image = closed_hand(factor);
    EXPECT_EQ(image.side_px, 16 * factor);
    ASSERT_EQ(image.rgba.size(), static_cast<std::size_t>(4 * image.side_px * image.side_px));
    const auto pixel = [&](int x, int y) {
      return std::pair(image.rgba[static_cast<std::size_t>(4 * (y * image.side_px + x))],
                       image.rgba[static_cast<std::size_t>(4 * (y * image.side_px + x) + 3)]);
    };
    for (int y = 0; y < image.side_px; ++y) {
      for (int x = 1; x < image.side_px; ++x) {
        // White never borders on what is behind the cursor.
        const auto [left, left_alpha] = pixel(x - 1, y);
        const auto [right, right_alpha] = pixel(x, y);
        EXPECT_FALSE(left == 255 && right_alpha == 0) << x << " " << y;
        EXPECT_FALSE(right == 255 && left_alpha == 0) << x << " " << y;
      }
    }
    EXPECT_EQ(pixel(image.hot_px, image.hot_px).second, 255);
  }
}

TEST_F(HandsTest, TheHandIsClosedWhileItHoldsTheGround) {
  open();
  window_->session().put({20, 10, 400'000, 0, -90, 0});
  move(700, 250);
  settle();
  const std::vector<std::uint32_t> arrow = robot_->cursor();
  const std::vector<std::uint32_t> hand = screen_pixels(closed_hand(1));
  EXPECT_NE(arrow, hand);
  robot_->press();
  iterate(3);
  EXPECT_EQ(robot_->cursor(), hand);
  move(720, 260);
  EXPECT_EQ(robot_->cursor(), hand);
  robot_->release();
  settle();
  EXPECT_EQ(robot_->cursor(), arrow);
  robot_->press(3);  // tilts: a ring, no hand
  iterate(3);
  EXPECT_EQ(robot_->cursor(), arrow);
  robot_->release(3);
  settle();
}

TEST_F(HandsTest, ARingMarksThePivotOfATilt) {
  open();
  window_->session().put({20, 10, 400'000, 0, -50, 0});
  settle();
  key("h");
  settle();
  const explore::Screen screen = window_->session().screen();
  ASSERT_EQ(screen.width, 960);
  const auto white_in = [](const core::RgbImage& image, double x, double y, int half) {
    int count = 0;
    for (int row = static_cast<int>(y) - half; row <= static_cast<int>(y) + half; ++row)
      for (int column = static_cast<int>(x) - half; column <= static_cast<int>(x) + half; ++column) {
        const base::Rgb p = image.pixels.at(static_cast<std::size_t>(row * image.width + column));
        count += std::min({p.r, p.g, p.b}) > 215 ? 1 : 0;
      }
    return count;
  };
  const double x = screen.width / 2.0;
  const double y = screen.height / 2.0;
  const core::RgbImage before = captured();
  move(600, 400);
  robot_->press(3);
  iterate(2);
  ASSERT_EQ(window_->session().mouse_use(), explore::MouseUse::kTilt);
  for (int n = 1; n <= 3; ++n) move(600 + 10 * n, 400 - 5 * n);
  ASSERT_TRUE(window_->session().held_m());
  const glm::dvec3 pivot_m = *window_->session().held_m();
  const core::View view = window_->session().view();
  const glm::dvec2 middle = core::project(view, pivot_m).xy;
  EXPECT_NEAR(middle.x, x, 0.5);
  EXPECT_NEAR(middle.y, y, 0.5);
  const core::RgbImage during = captured();
  EXPECT_GT(white_in(during, x, y, 2), 4) << "the dot";
  // The ring's northern and eastern points.
  const mars::LocalFrame frame = mars::local_frame(mars::lon_lat(pivot_m));
  const double radius_m = PivotMarkLimits::kRadius * glm::length(pivot_m - view.camera.position_m);
  for (const glm::dvec3& aside : {frame.north, frame.east, -frame.north, -frame.east}) {
    const glm::dvec2 p = core::project(view, pivot_m + radius_m * aside).xy;
    EXPECT_GT(white_in(during, p.x, p.y, 2), 2) << p.x << " " << p.y;
    EXPECT_EQ(white_in(before, p.x, p.y, 2), 0) << p.x << " " << p.y;
  }
  robot_->release(3);
  settle();
  EXPECT_EQ(white_in(captured(), x, y, 2), 0);
}

}  // namespace
}  // namespace vpe::window
