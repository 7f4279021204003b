// Times and attitudes of a file in the flight along its way.
#include "vpe/explore/traverse/stamped_way.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/explore/terrain_support.h"

namespace vpe::explore {
namespace {

constexpr double kR = mars::kMarsRadius_m;

mars::LonLat at_m(double east_m, double north_m) {
  return {east_m / kR / mars::kRadiansPerDegree, north_m / kR / mars::kRadiansPerDegree};
}

WayPoint point(double east_m, double north_m, std::optional<double> time_s = {},
               std::optional<double> yaw_deg = {}) {
  return {at_m(east_m, north_m), time_s, yaw_deg, {}, {}};
}

// Returns the poses at a place, in their order.
std::vector<scripts::Waypoint> poses_at(const Traverse& t, mars::LonLat place) {
  std::vector<scripts::Waypoint> found;
  for (const scripts::Waypoint& w : t.flight.waypoints)
    if (mars::distance_rad(place, {w.lon_deg, w.lat_deg}) * kR < 1e-6) found.push_back(w);
  return found;
}

TraverseOptions low() {
  TraverseOptions options;
  options.by = TraverseBy::kHeight;
  options.step_m = 10;
  return options;
}

std::string refusal(const std::vector<WayPoint>& points, const StampOptions& stamps = {}) {
  try {
    (void)make_stamped_traverse(points, low(), stamps, ball(kR));
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(StampedWay, WithoutStampsItIsTheTraverse) {
  const std::vector<WayPoint> points{point(0, 0), point(100, 0), point(100, 60)};
  const std::vector<mars::LonLat> places{points[0].place, points[1].place, points[2].place};
  for (const TraverseBy by : {TraverseBy::kWalk, TraverseBy::kDrive, TraverseBy::kHeight}) {
    TraverseOptions options;
    options.by = by;
    const Traverse stamped = make_stamped_traverse(points, options, {}, hills());
    const Traverse plain = make_traverse(places, options, hills());
    EXPECT_EQ(stamped.flight, plain.flight);
    EXPECT_EQ(stamped.duration_s, plain.duration_s);
  }
  EXPECT_FALSE(has_times(points));
  EXPECT_FALSE(has_times({}));
}

TEST(StampedWay, EachPointIsReachedAtItsTime) {
  const std::vector<WayPoint> points{point(0, 0, 1000), point(100, 0, 1050), point(100, 60, 1250)};
  ASSERT_TRUE(has_times(points));
  const Traverse t = make_stamped_traverse(points, low(), {}, ball(kR));
  EXPECT_EQ(t.flight.waypoints.front().time_s, 0);
  EXPECT_NEAR(poses_at(t, points[1].place).at(0).time_s, 50, 1e-6);
  EXPECT_NEAR(t.flight.waypoints.back().time_s, 250, 1e-9);
  EXPECT_NEAR(t.duration_s, 250, 1e-9);
  // Constant speed between points.
  for (std::size_t n = 1; n < t.flight.waypoints.size(); ++n) {
    const auto& a = t.flight.waypoints[n - 1];
    const auto& b = t.flight.waypoints[n];
    const double speed_m_s =
        mars::distance_rad({a.lon_deg, a.lat_deg}, {b.lon_deg, b.lat_deg}) * kR / (b.time_s - a.time_s);
    EXPECT_NEAR(speed_m_s, a.time_s < 49.99 ? 2 : 0.3, 1e-6) << n;
  }
  StampOptions faster;
  faster.scale = 10;
  EXPECT_NEAR(make_stamped_traverse(points, low(), faster, ball(kR)).duration_s, 25, 1e-9);
  StampOptions none;
  none.keeps_times = false;
  EXPECT_NEAR(make_stamped_traverse(points, low(), none, ball(kR)).duration_s, 160.0 / 50, 1e-9);
}

TEST(StampedWay, AStopHasTwoPoses) {
  const std::vector<WayPoint> points{point(0, 0, 0, 0),     point(0, 0, 7, 40),     point(100, 0, 20, 80),
                                     point(100, 0, 25, 90), point(100, 0, 30, 100), point(200, 0, 40, 120),
                                     point(200, 0, 50, 130)};
  const Traverse t = make_stamped_traverse(points, low(), {}, ball(kR));
  const auto first = poses_at(t, points[0].place);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0].time_s, 0);
  EXPECT_EQ(first[1].time_s, 7);
  EXPECT_EQ(first[1].yaw_deg, 40);
  const auto middle = poses_at(t, points[2].place);
  ASSERT_EQ(middle.size(), 2U);
  EXPECT_NEAR(middle[0].time_s, 20, 1e-9);
  EXPECT_EQ(middle[0].yaw_deg, 80);
  EXPECT_NEAR(middle[1].time_s, 30, 1e-9);
  EXPECT_EQ(middle[1].yaw_deg, 100);
  const auto last = poses_at(t, points[6].place);
  ASSERT_EQ(last.size(), 2U);
  EXPECT_EQ(last[1].time_s, 50);
  EXPECT_EQ(t.duration_s, 50);
  for (std::size_t n = 1; n < t.flight.waypoints.size(); ++n)
    EXPECT_GT(t.flight.waypoints[n].time_s, t.flight.waypoints[n - 1].time_s) << n;
}

TEST(StampedWay, AnglesAreInterpolatedOnTheShorterSide) {
  std::vector<WayPoint> points{point(0, 0, {}, 350), point(100, 0, {}, 10), point(200, 0)};
  points[0].pitch_deg = -10;
  points[1].pitch_deg = 20;
  points[0].roll_deg = 170;
  points[1].roll_deg = -170;
  const Traverse t = make_stamped_traverse(points, low(), {}, ball(kR));
  const auto half = poses_at(t, at_m(50, 0)).at(0);
  EXPECT_NEAR(std::remainder(half.yaw_deg, 360), 0, 1e-6);
  EXPECT_NEAR(half.pitch_deg, 5, 1e-6);
  EXPECT_NEAR(std::abs(half.roll_deg), 180, 1e-6);
  EXPECT_EQ(poses_at(t, points[1].place).at(0).yaw_deg, 10);
  // Along the ground where the file tells nothing.
  const auto after = poses_at(t, at_m(150, 0)).at(0);
  EXPECT_NEAR(after.yaw_deg, 90, 1e-6);
  EXPECT_EQ(after.pitch_deg, 0);
  EXPECT_EQ(after.roll_deg, 0);
}

TEST(StampedWay, AVehicleStandsOnTheGroundWithTheYawOfTheFile) {
  const TerrainQuery ground = rough_ground();
  TraverseOptions options;
  options.by = TraverseBy::kDrive;
  std::vector<WayPoint> points{point(0, 0, {}, 30), point(40, 0, {}, 30)};
  const Traverse t = make_stamped_traverse(points, options, {}, ground);
  for (const scripts::Waypoint& w : t.flight.waypoints) {
    const Contact c = contact({w.lon_deg, w.lat_deg}, 30, options.vehicle, ground);
    EXPECT_NEAR(w.yaw_deg, 30, 1e-9);
    EXPECT_NEAR(w.pitch_deg, c.pitch_deg, 1e-9);
    EXPECT_NEAR(w.roll_deg, c.roll_deg, 1e-9);
    EXPECT_NEAR(w.up_m, std::max(c.plane_m, c.ground_m) + options.vehicle.mast_m - c.ground_m, 1e-9);
  }
}

TEST(StampedWay, BadStampsAreRefused) {
  const auto has = [](const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
  };
  EXPECT_TRUE(has(refusal({point(0, 0, 1), point(9, 0)}), "1 of 2 points have a time"));
  EXPECT_TRUE(has(refusal({point(0, 0, 5), point(9, 0, 4)}), "point 2"));
  EXPECT_TRUE(has(refusal({point(0, 0, 5), point(9, 0, 5)}), "point 2"));
  EXPECT_TRUE(has(refusal({point(0, 0, 0), point(9, 0, 2e6)}), "--time-scale"));
  EXPECT_TRUE(has(refusal({point(0, 0, 0), point(0, 0, 2)}), "two different places"));
  EXPECT_TRUE(has(refusal({}), "two different places"));
  StampOptions wrong;
  wrong.scale = 0;
  EXPECT_TRUE(has(refusal({point(0, 0, 0), point(9, 0, 2)}, wrong), "scale"));
  StampOptions slow;
  slow.scale = 1e6;
  EXPECT_EQ(refusal({point(0, 0, 0), point(9, 0, 2e9)}, slow), "");
}

// Every point is reached at its time, whatever the way.
RC_GTEST_PROP(StampedWay, TimesAreThoseOfThePoints, ()) {
  const auto steps = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 400)));
  std::vector<WayPoint> points{point(0, 0, 0)};
  double east_m = 0;
  double time_s = 0;
  for (const int step : steps) {
    east_m += step;
    time_s += 1 + step % 17;
    points.push_back(point(east_m, 0, time_s));
  }
  RC_PRE(east_m > 0);
  const Traverse t = make_stamped_traverse(points, low(), {}, ball(kR));
  RC_ASSERT(std::abs(t.duration_s - time_s) < 1e-6);
  double last_s = -1;
  for (const scripts::Waypoint& w : t.flight.waypoints) {
    RC_ASSERT(w.time_s > last_s);
    last_s = w.time_s;
  }
}

}  // namespace
}  // namespace vpe::explore
