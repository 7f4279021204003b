// Hands on a window on a screen of its own: what tests of every window do.
#pragma once

#include <gtest/gtest.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <memory>
#include <string>

#include "tests/support/support.h"
#include "tests/window/robot.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

// `Window` has step(), is_at_rest(), display() and widgets(). The test opens it as window_ and calls
// take_hold().
template <class Window>
class HandsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!screen_.why_not().empty()) GTEST_SKIP() << "skipped: " << screen_.why_not();
    robot_ = std::make_unique<Robot>();
  }

  void take_hold() {
    glfwFocusWindow(window_->display().handle());
    settle();
  }

  // Turns of the loop until nothing moves, loads or waits.
  void settle() {
    for (int n = 0; n < 2000; ++n) {
      ASSERT_TRUE(window_->step(0.01));
      if (n > 5 && window_->is_at_rest()) return;
    }
    FAIL() << "the window does not come to rest";
  }
  void turns(int count) {
    for (int n = 0; n < count; ++n) ASSERT_TRUE(window_->step(0.01));
  }

  // Positions are of the window.
  void move(double x, double y) {
    int left = 0;
    int top = 0;
    glfwGetWindowPos(window_->display().handle(), &left, &top);
    robot_->move(x + left, y + top);
    turns(3);
  }
  void click(double x, double y) {
    move(x, y);
    robot_->press();
    turns(2);
    robot_->release();
    turns(2);
  }
  void click(const std::string& label) {
    const auto found = window_->widgets().places().find(label);
    ASSERT_NE(found, window_->widgets().places().end()) << "no widget is called " << label;
    const WidgetPlace& p = found->second;
    click((p.x0 + p.x1) / 2, (p.y0 + p.y1) / 2);
  }
  const WidgetPlace& place_of(const std::string& label) { return window_->widgets().places().at(label); }
  void key(const std::string& name) {
    robot_->key(name);
    turns(3);
  }

  test_support::TempDir folder_;
  Screen screen_{2600, 1500};
  std::unique_ptr<Robot> robot_;
  std::unique_ptr<Window> window_;
};

}  // namespace vpe::window
