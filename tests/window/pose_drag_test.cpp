// Tests of poses of a flight that are dragged in the view.
#include "vpe/window/marks/pose_drag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/support.h"
#include "tests/window/explore_window_fixture.h"
#include "vpe/explore/mouse.h"

namespace vpe::window {
namespace {

constexpr double kRadius_m = 3.4e6;

TEST(PoseDragTest, APoseIsSeenAtTheCursor) {
  std::mt19937 random(20261125);
  const auto from = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int compared = 0;
  double worst_px = 0;
  for (int n = 0; n < 400; ++n) {
    const double level_m = from(100, 50'000);
    const double above_m = from(2'000, 300'000);
    const mars::Pose pose{from(-180, 180), from(-60, 60), level_m + above_m, from(0, 360), from(-80, -30), 0};
    const core::View view = explore::view_of(pose, {800, 600, 50}, kRadius_m);
    // Level, or over hills whose slopes are less steep than the lines of sight.
    const double hills_m = n % 2 == 0 ? 0 : 0.01 * above_m;
    const auto radius_m = [&](mars::LonLat at) {
      return kRadius_m + level_m + hills_m * std::sin(5 * at.lon_deg) * std::cos(4 * at.lat_deg);
    };
    const mars::LonLat start{pose.lon_deg, std::clamp(pose.lat_deg + 0.01, -89.0, 89.0)};
    const glm::dvec2 xy{from(100, 700), from(250, 590)};
    const mars::LonLat place = dragged_pose(view, start, xy, radius_m);
    const core::Projected seen = core::project(view, mars::direction(place) * radius_m(place));
    ASSERT_FALSE(seen.behind);
    // Hills are reached by steps, level ground at once.
    const double off_px = glm::length(seen.xy - xy);
    if (hills_m == 0) worst_px = std::max(worst_px, off_px);
    compared += off_px < (hills_m == 0 ? 1e-3 : 1.0) ? 1 : 0;
  }
  EXPECT_LT(worst_px, 1e-3);
  EXPECT_GT(compared, 380);
}

// A camera at the level of the pose: the pose moves sideways and does not leave.
TEST(PoseDragTest, WhereTheSightGrazesTheLevelTheDistanceStays) {
  const mars::Pose pose{20, 10, 3000, 0, 0, 0};
  const core::View view = explore::view_of(pose, {800, 600, 50}, kRadius_m);
  const mars::LonLat start{20, 10.1};
  const double distance_rad = mars::distance_rad({20, 10}, start);
  for (const double up_m : {2000.0, 3000.0, 3100.0}) {
    const auto radius_m = [up_m](mars::LonLat) { return kRadius_m + up_m; };
    for (const glm::dvec2 xy : {glm::dvec2{400, 295}, {400, 305}, {600, 300}, {150, 290}}) {
      const mars::LonLat place = dragged_pose(view, start, xy, radius_m);
      EXPECT_NEAR(mars::distance_rad({20, 10}, place), distance_rad, 1e-9) << up_m;
      const double azimuth_deg = std::atan2(xy.x - 400, core::focal_px(view)) / mars::kRadiansPerDegree;
      EXPECT_NEAR(std::remainder(mars::initial_bearing_deg({20, 10}, place) - azimuth_deg, 360.0), 0, 1e-6);
    }
  }
}

class FlightDragTest : public ExploreWindowTest {
 protected:
  const scripts::Waypoint& waypoint(std::size_t n) {
    return window_->session().flights().editor()->flight().waypoints.at(n);
  }
  // Returns where the mark of a pose is in the window.
  glm::dvec2 mark(std::size_t n) {
    const scripts::Waypoint& w = waypoint(n);
    const glm::dvec3 d = mars::direction({w.lon_deg, w.lat_deg});
    const explore::TerrainQuery& ground = window_->session().ground();
    const double r = ground.radius_m + w.up_m + (w.above_terrain ? ground.height_m(d) : 0);
    return core::project(window_->session().view(), d * r).xy + glm::dvec2{330, 0};
  }
  void drag(std::size_t n, glm::dvec2 by) {
    const glm::dvec2 from = mark(n);
    move(from.x + 2, from.y - 1);
    robot_->press();
    iterate(2);
    for (int k = 1; k <= 5; ++k) move(from.x + 2 + by.x * k / 5, from.y - 1 + by.y * k / 5);
    robot_->release();
    iterate(3);
  }
};

TEST_F(FlightDragTest, APoseIsDraggedInTheViewAsOneStep) {
  open();
  window_->session().put({20, 10, 600'000, 0, -90, 0});
  scripts::Flight flight;
  flight.waypoints.resize(3);
  for (std::size_t n = 0; n < 3; ++n) {
    scripts::Waypoint& w = flight.waypoints[n];
    w.time_s = 10.0 * static_cast<double>(n);
    w.lon_deg = 18 + 2.0 * static_cast<double>(n);
    w.lat_deg = 10;
    w.up_m = 60'000;
    w.above_terrain = n == 2;
  }
  ASSERT_EQ(window_->session().flights().load(flight), "");
  settle();
  const mars::Pose camera = window_->session().pose();
  // Without the panel a drag is one of the ground.
  drag(1, {30, 20});
  settle();
  EXPECT_EQ(waypoint(1), flight.waypoints[1]);
  EXPECT_NE(window_->session().pose().lon_deg, camera.lon_deg);
  window_->session().put(camera);
  click("Flight");
  settle();
  for (const std::size_t n : {std::size_t{1}, std::size_t{2}}) {
    const glm::dvec2 before = mark(n);
    const std::size_t steps = window_->session().flights().editor()->undo_steps();
    drag(n, {45, 60});
    EXPECT_NEAR(mark(n).x, before.x + 45, 1.5) << n;
    EXPECT_NEAR(mark(n).y, before.y + 60, 1.5) << n;
    EXPECT_EQ(waypoint(n).up_m, 60'000);
    EXPECT_EQ(waypoint(n).yaw_deg, flight.waypoints[n].yaw_deg);
    EXPECT_EQ(window_->session().flights().editor()->undo_steps(), steps + 1);
    EXPECT_EQ(window_->session().pose().lon_deg, camera.lon_deg);
    EXPECT_EQ(window_->session().pose().lat_deg, camera.lat_deg);
  }
  // Two drags of one pose are two steps.
  drag(1, {-20, 0});
  for (int n = 0; n < 3; ++n) {
    robot_->key_down("Control_L");
    key("z");
    robot_->key_up("Control_L");
    iterate(3);
  }
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(waypoint(n), flight.waypoints[n]);
}

}  // namespace
}  // namespace vpe::window
