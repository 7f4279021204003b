#include "vpe/explore/traverse/traverse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "scripts/path.h"
#include "tests/explore/terrain_support.h"
#include "vpe/explore/steer.h"
#include "vpe/explore/traverse/tour.h"
#include "vpe/explore/walk.h"

namespace vpe::explore {
namespace {

constexpr double kR = mars::kMarsRadius_m;

// The place that is so many metres to the east and north of longitude and latitude 0.
mars::LonLat at_m(double east_m, double north_m) {
  return {east_m / kR / mars::kRadiansPerDegree, north_m / kR / mars::kRadiansPerDegree};
}

const std::vector<mars::LonLat> kCorner{at_m(0, 0), at_m(100, 0), at_m(100, 60)};

TEST(Traverse, HoldsEveryPointOfTheWayAndItsLength) {
  const Traverse t = make_traverse(kCorner, {}, ball(kR));
  EXPECT_NEAR(t.length_m, 160, 1e-6);
  EXPECT_EQ(t.flight.waypoints.size(), 81U);
  EXPECT_NEAR(t.duration_s, 160 / stride_m_s(0), 1e-6);
  for (const mars::LonLat& place : kCorner) {
    double nearest_m = 1e9;
    for (const scripts::Waypoint& w : t.flight.waypoints)
      nearest_m = std::min(nearest_m, mars::distance_rad(place, {w.lon_deg, w.lat_deg}) * kR);
    EXPECT_LT(nearest_m, 1e-6);
  }
  EXPECT_NEAR(t.flight.waypoints[10].yaw_deg, 90, 1e-6);
  EXPECT_NEAR(t.flight.waypoints[50].yaw_deg, 45, 1e-3) << "half turned in the corner";
  EXPECT_NEAR(std::remainder(t.flight.waypoints[70].yaw_deg, 360.0), 0, 1e-6);
  for (const scripts::Waypoint& w : t.flight.waypoints) {
    EXPECT_EQ(w.up_m, WalkLimits::kEye_m);
    EXPECT_TRUE(w.above_terrain);
    EXPECT_EQ(w.pitch_deg, 0);
  }
}

TEST(Traverse, TheWalkersSpeedFollowsTheSlope) {
  TraverseOptions options;
  const double up_s =
      make_traverse(std::vector{at_m(0, 0), at_m(100, 0)}, options, sloping_ground(0.2, 0)).duration_s;
  const double down_s =
      make_traverse(std::vector{at_m(100, 0), at_m(0, 0)}, options, sloping_ground(0.2, 0)).duration_s;
  EXPECT_NEAR(up_s, 100 / stride_m_s(0.2), 1e-3);
  EXPECT_NEAR(down_s, 100 / stride_m_s(-0.2), 1e-3);
  options.speed_m_s = 2.8;
  const double fast_s =
      make_traverse(std::vector{at_m(0, 0), at_m(100, 0)}, options, sloping_ground(0.2, 0)).duration_s;
  EXPECT_NEAR(up_s / fast_s, 2.8 / stride_m_s(0), 1e-6);
}

TEST(Traverse, TheRoverHasTheAttitudeOfItsContact) {
  const TerrainQuery ground = rough_ground();
  TraverseOptions options;
  options.by = TraverseBy::kDrive;
  const Traverse t = make_traverse(kCorner, options, ground);
  EXPECT_GT(t.flight.waypoints.size(), 150U);
  double most_deg = 0;
  for (const scripts::Waypoint& w : t.flight.waypoints) {
    const Contact c = contact({w.lon_deg, w.lat_deg}, w.yaw_deg, options.vehicle, ground);
    EXPECT_NEAR(w.pitch_deg, c.pitch_deg, 1e-6);
    EXPECT_NEAR(w.roll_deg, c.roll_deg, 1e-6);
    EXPECT_GE(w.up_m, options.vehicle.mast_m - 1e-6);
    most_deg = std::max(most_deg, c.slope_deg);
  }
  EXPECT_NEAR(t.steepest_deg, most_deg, 1e-6);
  EXPECT_NEAR(t.duration_s, t.length_m / options.vehicle.speed_m_s, 1e-6);
}

TEST(Traverse, SlopesBeyondTheLimitAreCounted) {
  TraverseOptions options;
  options.by = TraverseBy::kDrive;
  const std::vector<mars::LonLat> way{at_m(0, 0), at_m(50, 0)};
  EXPECT_EQ(make_traverse(way, options, sloping_ground(0.5, 0)).too_steep, 0U);
  const Traverse steep = make_traverse(way, options, sloping_ground(1, 0));
  EXPECT_EQ(steep.too_steep, steep.flight.waypoints.size());
  EXPECT_NEAR(steep.steepest_deg, 45, 0.1);
  options.by = TraverseBy::kWalk;
  const Traverse climb = make_traverse(way, options, sloping_ground(1, 0));
  EXPECT_EQ(climb.too_steep, climb.flight.waypoints.size() - 1);
  options.by = TraverseBy::kHeight;
  EXPECT_EQ(make_traverse(way, options, sloping_ground(1, 0)).too_steep, 0U);
}

// The flight is text; played, it is at each pose what the traverse computed, and never below the ground at one.
TEST(Traverse, ReplaysToTheBit) {
  const TerrainQuery ground = rough_ground();
  for (const TraverseBy by : {TraverseBy::kWalk, TraverseBy::kDrive, TraverseBy::kHeight}) {
    TraverseOptions options;
    options.by = by;
    const Traverse t = make_traverse(kCorner, options, ground);
    const scripts::ParsedFlight parsed = scripts::parse_flight(scripts::to_text(t.flight), "t");
    ASSERT_TRUE(parsed.flight.has_value()) << scripts::to_string(parsed.errors.front());
    EXPECT_EQ(*parsed.flight, t.flight);
    EXPECT_EQ(make_traverse(kCorner, options, ground).flight, t.flight);
    const scripts::Path path(*parsed.flight, kR,
                             [&](mars::LonLat p, double) { return ground.height_m(mars::direction(p)); });
    for (const scripts::Waypoint& w : t.flight.waypoints) {
      const mars::Pose pose = path.at(w.time_s).pose;
      EXPECT_EQ(pose.lon_deg, w.lon_deg);
      EXPECT_EQ(pose.pitch_deg, w.pitch_deg);
      EXPECT_GE(height_above_ground_m(pose, ground), 1.0);
    }
  }
}

TEST(Traverse, WaysThatTurnBackAndRepeatPointsWork) {
  const std::vector<mars::LonLat> way{at_m(0, 0), at_m(0, 0), at_m(50, 0), at_m(0, 0), at_m(0, 0)};
  for (const TraverseBy by : {TraverseBy::kWalk, TraverseBy::kDrive, TraverseBy::kHeight}) {
    TraverseOptions options;
    options.by = by;
    const Traverse t = make_traverse(way, options, ball(kR));
    EXPECT_NEAR(t.length_m, 100, 1e-6);
    double before_s = -1;
    for (const scripts::Waypoint& w : t.flight.waypoints) {
      EXPECT_GT(w.time_s, before_s);
      before_s = w.time_s;
      EXPECT_TRUE(std::isfinite(w.yaw_deg));
    }
    EXPECT_NEAR(t.flight.waypoints.front().yaw_deg, 90, 1e-6);
    EXPECT_NEAR(std::remainder(t.flight.waypoints.back().yaw_deg + 90, 360.0), 0, 1e-6);
  }
}

TEST(Traverse, ALongWayHasABoundedNumberOfPoses) {
  const Traverse t = make_traverse(std::vector{mars::LonLat{0, 0}, mars::LonLat{20, 10}}, {}, ball(kR));
  EXPECT_LE(t.flight.waypoints.size(), 20'002U);
  EXPECT_GE(t.flight.waypoints.size(), 19'000U);
}

void refuses(const std::vector<mars::LonLat>& way, const TraverseOptions& options, const std::string& part) {
  try {
    (void)make_traverse(way, options, ball(kR));
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

TEST(Traverse, BadInputIsNamed) {
  const auto with = [](auto change) {
    TraverseOptions o;
    change(o);
    return o;
  };
  refuses({}, {}, "two different places");
  refuses({{1, 2}}, {}, "two different places");
  refuses({{1, 2}, {1, 2}}, {}, "two different places");
  refuses({{0, 0}, {180, 0}}, {}, "opposite");
  refuses(kCorner, with([](auto& o) { o.speed_m_s = 0; }), "speed");
  refuses(kCorner, with([](auto& o) { o.speed_m_s = std::nan(""); }), "speed");
  refuses(kCorner, with([](auto& o) { o.camera_height_m = -1; }), "eye");
  refuses(kCorner, with([](auto& o) { o.step_m = 0; }), "step");
  refuses(kCorner, with([](auto& o) { o.vehicle.wheels = 3; }), "wheels");
  refuses({{0, 0}, {90, 0}}, with([](auto& o) { o.step_m = 1; }), "larger step");
  refuses({{0, 0}, {90, 0}}, with([](auto& o) { o.speed_m_s = 0.01; }), "higher speed");
}

mars::KmlPoint camera(double lon_deg, double altitude_m, mars::KmlView view) {
  return {{lon_deg, 0}, altitude_m, false, view};
}

TEST(Tour, CamerasStandWhereTheyAreAndLookAtsLookAtTheirPoint) {
  const TerrainQuery ground = sloping_ground(0.01, 0);
  const std::vector<mars::KmlPoint> points{camera(1, 500, {30, 80, 4, std::nullopt, 9}),
                                           camera(2, 0, {60, 50, 0, 20'000, 7}), camera(3, 100, {})};
  const scripts::Flight flight = make_tour(points, 1000, ground);
  ASSERT_EQ(flight.waypoints.size(), 3U);
  const scripts::Waypoint& first = flight.waypoints[0];
  EXPECT_EQ(first.time_s, 0);
  EXPECT_NEAR(first.up_m, ground.height_m(mars::direction({1, 0})) + 500, 1e-6);
  EXPECT_EQ(first.pitch_deg, -10);
  EXPECT_EQ(first.roll_deg, 4);
  const scripts::Waypoint& second = flight.waypoints[1];
  EXPECT_EQ(second.time_s, 7);
  // The point is straight ahead at its range, and the horizon is level.
  const mars::Pose pose{second.lon_deg, second.lat_deg,   second.up_m,
                        second.yaw_deg, second.pitch_deg, second.roll_deg};
  const mars::CameraPose seen = mars::to_camera(pose, kR);
  const glm::dvec3 point_m = mars::direction({2, 0}) * (kR + ground.height_m(mars::direction({2, 0})));
  EXPECT_LT(glm::length(seen.position_m + seen.axes.forward * 20'000.0 - point_m), 1e-3);
  const mars::LocalFrame frame = mars::local_frame({2, 0});
  EXPECT_NEAR(std::asin(glm::dot(seen.axes.forward, frame.up)) / mars::kRadiansPerDegree, -40, 1e-6);
  EXPECT_NEAR(glm::dot(seen.axes.right, frame.up), 0, 1e-9);
  EXPECT_EQ(flight.waypoints[2].pitch_deg, -90);
  EXPECT_GT(flight.waypoints[2].time_s, 40) << "by the speed, as it has no duration";
  EXPECT_TRUE(scripts::parse_flight(scripts::to_text(flight), "t").flight.has_value());
}

TEST(Tour, BadInputIsNamed) {
  const mars::KmlPoint view = camera(1, 500, {0, 80, 0, std::nullopt, std::nullopt});
  mars::KmlPoint none = view;
  none.view.reset();
  EXPECT_THROW((void)make_tour(std::vector{view}, 1, ball(kR)), std::invalid_argument);
  EXPECT_THROW((void)make_tour(std::vector{view, none}, 1, ball(kR)), std::invalid_argument);
  EXPECT_THROW((void)make_tour(std::vector{view, view}, 0, ball(kR)), std::invalid_argument);
  EXPECT_THROW((void)make_tour(std::vector{view, camera(90, 0, {})}, 0.001, ball(kR)), std::invalid_argument);
  const scripts::Flight same = make_tour(std::vector{view, view}, 1, ball(kR));
  EXPECT_EQ(same.waypoints[1].time_s, TourLimits::kShortest_s);
}

}  // namespace
}  // namespace vpe::explore
