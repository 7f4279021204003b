// Fixture for tests of any window: a virtual screen, simulated input, iterations of the event loop.
#pragma once

#include <gtest/gtest.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <functional>
#include <memory>
#include <string>

#include "tests/support/support.h"
#include "tests/window/robot.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// `Window` has step(), is_at_rest(), display() and widgets(). The test opens it as window_ and calls
// focus().
template <class Window>
class WindowTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!screen_.why_not().empty()) GTEST_SKIP() << "skipped: " << screen_.why_not();
    robot_ = std::make_unique<Robot>();
  }

  void focus() {
    glfwFocusWindow(window_->display().handle());
    settle();
  }

  // Runs one iteration of the event loop. A clock of the test's own goes on by a frame's time.
  bool step() {
    time_s_ += 0.01;
    return window_->step(0.01);
  }
  // Returns a clock for DisplayOptions that only step() moves: what depends on speed of hands and on time
  // between images is then the same on every machine.
  std::function<double()> own_clock() {
    return [this] { return time_s_; };
  }

  // Runs the event loop until nothing moves, loads or waits.
  void settle() {
    for (int n = 0; n < 30'000; ++n) {
      ASSERT_TRUE(step());
      if (n > 5 && window_->is_at_rest()) return;
    }
    FAIL() << "the window does not come to rest";
  }
  void iterate(int count) {
    for (int n = 0; n < count; ++n) ASSERT_TRUE(step());
  }

  // Positions are in pixels of the window.
  void move(double x, double y) {
    int left = 0;
    int top = 0;
    glfwGetWindowPos(window_->display().handle(), &left, &top);
    robot_->move(x + left, y + top);
    iterate(3);
  }
  void click(double x, double y) {
    move(x, y);
    robot_->press();
    iterate(2);
    robot_->release();
    iterate(2);
  }
  // Waits for a frame that shows the widget.
  bool waits_for(const std::string& label, bool is_there = true) {
    for (int n = 0; n < 5'000 && window_->widgets().places().contains(label) != is_there; ++n)
      if (!step()) return false;
    return window_->widgets().places().contains(label) == is_there;
  }
  void click(const std::string& label) {
    waits_for(label);
    const auto found = window_->widgets().places().find(label);
    ASSERT_NE(found, window_->widgets().places().end()) << "no widget is called " << label;
    const WidgetPlace& p = found->second;
    click((p.x0 + p.x1) / 2, (p.y0 + p.y1) / 2);
  }
  const WidgetPlace& place_of(const std::string& label) { return window_->widgets().places().at(label); }
  void key(const std::string& name) {
    robot_->key(name);
    iterate(3);
  }
  void with_control(const std::string& name, bool shift = false) {
    robot_->key_down("Control_L");
    if (shift) robot_->key_down("Shift_L");
    key(name);
    if (shift) robot_->key_up("Shift_L");
    robot_->key_up("Control_L");
    iterate(3);
  }

  double time_s_ = 0;  // of own_clock()
  test_support::TempDir folder_;
  Screen screen_{2600, 1500};
  std::unique_ptr<Robot> robot_;
  std::unique_ptr<Window> window_;
};

}  // namespace vpe::window
