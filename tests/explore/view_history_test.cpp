#include "vpe/explore/files/view_history.h"

#include <gtest/gtest.h>

namespace vpe::explore {
namespace {

SavedView view_at(double lon_deg, double yaw_deg = 0, double fov_deg = 60) {
  return {{lon_deg, 10, 5000, yaw_deg, -10, 0}, fov_deg};
}

// Imitates a user: time passes, the camera moves and rests.
class History : public ::testing::Test {
 protected:
  void pass(const SavedView& view) { history_.observe(now_s_ += 0.03, view, 5000); }
  void rest_at(const SavedView& view) {
    pass(view);
    now_s_ += 10;
  }
  void expect_back(double lon_deg) {
    const auto view = history_.back();
    ASSERT_TRUE(view.has_value());
    EXPECT_EQ(view->pose.lon_deg, lon_deg);
  }
  void expect_forward(double lon_deg) {
    const auto view = history_.forward();
    ASSERT_TRUE(view.has_value());
    EXPECT_EQ(view->pose.lon_deg, lon_deg);
  }

  double now_s_ = 0;
  ViewHistory history_{mars::kMarsRadius_m};
};

TEST_F(History, LeadsBackAndForthThroughViewsThatRested) {
  for (const double lon : {1, 2, 3}) rest_at(view_at(lon));
  EXPECT_TRUE(history_.can_go_back());
  EXPECT_FALSE(history_.can_go_forward());
  expect_back(2);
  rest_at(view_at(2));
  expect_back(1);
  rest_at(view_at(1));
  EXPECT_FALSE(history_.can_go_back());
  EXPECT_FALSE(history_.back().has_value());
  expect_forward(2);
  rest_at(view_at(2));
  expect_forward(3);
  rest_at(view_at(3));
  EXPECT_FALSE(history_.forward().has_value());
  EXPECT_EQ(history_.size(), 3U);
}

TEST_F(History, ViewsOnTheWayAreNotStored) {
  rest_at(view_at(1));
  for (double lon = 1; lon < 20; lon += 0.1) pass(view_at(lon));
  rest_at(view_at(20));
  expect_back(1);
  EXPECT_EQ(history_.size(), 2U);
}

TEST_F(History, SmallMotionsMergeButDriftMakesNewEntries) {
  rest_at(view_at(1));
  rest_at(view_at(1, 2));
  rest_at(view_at(1, 4));
  rest_at(view_at(30));
  EXPECT_EQ(history_.back()->pose.yaw_deg, 4);  // as it was left
  rest_at(view_at(1, 4));
  EXPECT_EQ(history_.size(), 2U);
  ViewHistory drifting(mars::kMarsRadius_m);
  for (int n = 0; n <= 90; ++n) drifting.observe(10.0 * n, view_at(1, n), 5000);
  EXPECT_GE(drifting.size(), 12U);
  EXPECT_LE(drifting.size(), 19U);
}

TEST_F(History, RotationZoomAndMotionAllCount) {
  rest_at(view_at(1));
  rest_at(view_at(1, 20));
  rest_at(view_at(1, 20, 30));
  rest_at(view_at(1.1, 20, 30));
  rest_at(view_at(5));
  EXPECT_EQ(history_.size(), 4U);  // the last one has not been left
}

TEST_F(History, GoingElsewhereAfterBackDropsTheViewsAhead) {
  for (const double lon : {1, 2, 3}) rest_at(view_at(lon));
  expect_back(2);
  rest_at(view_at(2));
  rest_at(view_at(50));
  pass(view_at(51));
  EXPECT_FALSE(history_.can_go_forward());
  expect_back(50);
  rest_at(view_at(50));
  expect_back(2);
}

TEST_F(History, TheWayToAViewAddsNothingAndMayBeInterrupted) {
  for (const double lon : {1, 2, 3, 4}) rest_at(view_at(lon));
  expect_back(3);
  for (double lon = 3.9; lon > 3.4; lon -= 0.05) pass(view_at(lon));
  expect_back(2);  // on the way to 3
  for (double lon = 3.4; lon > 2.01; lon -= 0.05) pass(view_at(lon));
  rest_at(view_at(2));
  EXPECT_EQ(history_.size(), 4U);
  expect_forward(3);
  rest_at(view_at(3));
  expect_forward(4);
}

TEST_F(History, AViewThatHasNotRestedIsReachedByForward) {
  rest_at(view_at(1));
  rest_at(view_at(2));
  pass(view_at(7));
  expect_back(2);
  rest_at(view_at(2));
  expect_forward(7);
}

TEST(HistoryLimits, TheOldestGoFirst) {
  ViewHistory history(mars::kMarsRadius_m, {.capacity = 5});
  for (int n = 0; n < 20; ++n) history.observe(10.0 * n, view_at(n), 5000);
  EXPECT_EQ(history.size(), 5U);
  int steps = 0;
  double lon = 0;
  while (const auto view = history.back()) {
    lon = view->pose.lon_deg;
    ++steps;
  }
  EXPECT_EQ(steps, 4);
  EXPECT_EQ(lon, 15);
}

TEST(HistoryLimits, IsEmptyBeforeTheFirstView) {
  ViewHistory history(mars::kMarsRadius_m);
  EXPECT_FALSE(history.can_go_back());
  EXPECT_FALSE(history.back().has_value());
  EXPECT_FALSE(history.forward().has_value());
  history.observe(0, view_at(1), 5000);
  EXPECT_FALSE(history.back().has_value());
}

}  // namespace
}  // namespace vpe::explore
