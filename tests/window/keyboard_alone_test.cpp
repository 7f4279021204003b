// Tests that the keyboard alone reaches everything: panels, files, drawings, measuring.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/window/explore_window_fixture.h"

namespace vpe::window {
namespace {

using Words = std::vector<std::string>;

class DoneJob : public Job {
 public:
  JobState state() override { return {false, 1, "", false}; }
  void stop() override {}
};

class KeyboardAlone : public ExploreWindowTest {
 protected:
  // Moves the highlight to a widget by arrows. Returns false if it does not get there.
  bool reach(const std::string& label) {
    double before_x = -1;
    double before_y = -1;
    for (int n = 0; n < 120; ++n) {
      const auto at = PanelFocus::highlight();
      const auto found = window_->widgets().places().find(label);
      if (!at || found == window_->widgets().places().end()) {
        key("Down");
        continue;
      }
      const WidgetPlace& to = found->second;
      const double x = (at->x0 + at->x1) / 2;
      const double y = (at->y0 + at->y1) / 2;
      if (x > to.x0 && x < to.x1 && y > to.y0 && y < to.y1) return true;
      const bool is_stuck = x == before_x && y == before_y;
      before_x = x;
      before_y = y;
      const double down = (to.y0 + to.y1) / 2 - y;
      if (std::abs(down) < 8 || is_stuck)
        key((to.x0 + to.x1) / 2 > x ? "Right" : "Left");
      else
        key(down > 0 ? "Down" : "Up");
    }
    return false;
  }
  void press(const std::string& label) {
    ASSERT_TRUE(reach(label)) << label;
    key("space");
    iterate(5);
  }
};

TEST_F(KeyboardAlone, LeadsFromPanelToPanelAndBack) {
  open(1280, 720);
  move(800, 300);
  const mars::Pose before = window_->session().pose();
  EXPECT_FALSE(window_->keys_are_in_panels());
  key("F6");
  EXPECT_TRUE(window_->keys_are_in_panels());
  ASSERT_TRUE(PanelFocus::highlight());
  const double side_px = place_of("side edge").x1;
  EXPECT_LT(PanelFocus::highlight()->x0, side_px);
  for (const char* name : {"Down", "Right", "w", "n", "Up"}) key(name);
  settle();
  EXPECT_EQ(window_->session().pose().lat_deg, before.lat_deg);
  EXPECT_EQ(window_->session().pose().alt_m, before.alt_m);
  EXPECT_EQ(window_->session().pose().yaw_deg, before.yaw_deg);
  key("F6");
  ASSERT_TRUE(PanelFocus::highlight());
  EXPECT_GT(PanelFocus::highlight()->x0, side_px);  // over the view
  for (int n = 0; n < 6 && window_->keys_are_in_panels(); ++n) key("F6");
  EXPECT_FALSE(window_->keys_are_in_panels());
  key("F6");
  EXPECT_TRUE(window_->keys_are_in_panels());
  key("Escape");
  EXPECT_FALSE(window_->keys_are_in_panels());
  EXPECT_FALSE(PanelFocus::highlight());
  robot_->key_down("w");
  iterate(20);
  robot_->key_up("w");
  settle();
  EXPECT_NE(window_->session().pose().alt_m, before.alt_m);
}

TEST_F(KeyboardAlone, ReachesPanelsAndFields) {
  open(1280, 720);
  key("F6");
  press("Large map");
  EXPECT_TRUE(window_->state().large_map);
  press("Large map");
  press("Look");
  press("Slope");
  EXPECT_EQ(window_->session().settings().get("colour"), "slope");
  press("Measure");
  press("Draw");
  press("View");
  ASSERT_TRUE(reach("Altitude (m)"));
  key("Return");
  robot_->key_down("Control_L");
  key("a");
  robot_->key_up("Control_L");
  for (const char* digit : {"9", "0", "0", "0", "0", "0"}) key(digit);
  key("Return");
  iterate(5);
  EXPECT_EQ(window_->session().pose().alt_m, 900'000);
  press("Rays");
  EXPECT_EQ(window_->state().drawn_by, core::DrawnBy::kRay);
}

TEST_F(KeyboardAlone, SavesAnImage) {
  std::vector<Words> commands;
  extra_.start_job = [&commands](const Words& words) {
    commands.push_back(words);
    return std::make_unique<DoneJob>();
  };
  open(1280, 720);
  robot_->key_down("Control_L");
  key("o");
  robot_->key_up("Control_L");
  iterate(5);
  key("Escape");  // out of the field
  iterate(3);
  if (!window_->state().files) {
    robot_->key_down("Control_L");
    key("o");
    robot_->key_up("Control_L");
  }
  key("F6");
  press("file/Save image");
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands.front()[0], "render");
}

TEST_F(KeyboardAlone, DrawsAndMeasuresInTheMiddleOfTheView) {
  open(1280, 720);
  move(100, 600);  // the cursor is not over the view
  key("F6");
  press("Draw");
  press("Line");
  key("Escape");
  ASSERT_TRUE(window_->drawing().sketch().tool());
  key("v");
  const mars::Pose first = window_->session().pose();
  window_->session().put({first.lon_deg + 5, first.lat_deg, first.alt_m, 0, -90, 0});
  key("v");
  key("Return");
  settle();
  ASSERT_EQ(window_->drawing().drawings().all().size(), 1U);
  const auto& line = *window_->drawing().drawings().all()[0];
  ASSERT_EQ(line.vertices.size(), 2U);
  EXPECT_NEAR(line.vertices[1].lon_deg - line.vertices[0].lon_deg, 5, 0.1);
  key("m");
  key("F6");
  press("Measure");
  EXPECT_FALSE(window_->state().message_is_error) << window_->state().message;
}

}  // namespace
}  // namespace vpe::window
