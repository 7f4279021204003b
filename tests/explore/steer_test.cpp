#include "vpe/explore/steer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/explore/terrain_support.h"

namespace vpe::explore {
namespace {

using mars::Pose;

constexpr double kR = mars::kMarsRadius_m;

double between(int lo, int hi, int n, int of) { return lo + (hi - lo) * static_cast<double>(n) / of; }

Pose some_pose() {
  const int n = *rc::gen::inRange(0, 1'000'001);
  const int m = *rc::gen::inRange(0, 1'000'001);
  const int k = *rc::gen::inRange(0, 1'000'001);
  const int j = *rc::gen::inRange(0, 1'000'001);
  return {between(-180, 180, n, 1'000'000),
          between(-90, 90, m, 1'000'000),
          10.0 * std::pow(10.0, between(0, 6, k, 1'000'000)),
          between(-180, 180, j, 1'000'000),
          between(-90, 90, (n + j) % 1'000'001, 1'000'000),
          between(-180, 180, (m + k) % 1'000'001, 1'000'000)};
}

TEST(Steer, AheadIsAGreatCircleOfTheRightLength) {
  const TerrainQuery ground = ball(kR);
  const Pose start{10, 40, 5000, 30, -20, 5};
  const Pose end = moved(start, 0, 0, 200'000, ground);
  const mars::LonLat expected = mars::destination({10, 40}, 30, 200'000 / (kR + 5000));
  EXPECT_NEAR(end.lon_deg, expected.lon_deg, 1e-10);
  EXPECT_NEAR(end.lat_deg, expected.lat_deg, 1e-10);
  EXPECT_NEAR(end.alt_m, 5000, 1e-6);
  // The camera turns with the circle: looking back, the start is straight behind.
  EXPECT_NEAR(std::remainder(mars::initial_bearing_deg(expected, {10, 40}) - 180.0 - end.yaw_deg, 360.0), 0,
              1e-9);
  EXPECT_EQ(end.pitch_deg, -20);
  EXPECT_EQ(end.roll_deg, 5);
}

TEST(Steer, ContinuesOverThePole) {
  const TerrainQuery ground = ball(kR);
  const Pose end =
      moved({20, 89.9, 1000, 0, -10, 0}, 0, 0, 0.2 * mars::kRadiansPerDegree * (kR + 1000), ground);
  EXPECT_NEAR(end.lat_deg, 89.9, 1e-9);
  EXPECT_NEAR(end.lon_deg, -160, 1e-6);
  EXPECT_NEAR(std::abs(end.yaw_deg), 180, 1e-6);
}

TEST(Steer, ControlsMoveAlongTheCamerasAxes) {
  const TerrainQuery ground = ball(kR);
  const Pose start{0, 0, 1000, 90, 0, 0};
  const double full = full_speed_m_s(start, ground);
  EXPECT_NEAR(full, 700, 1e-9);
  const Pose ahead = steered(start, {.forward = 1}, 0.1, ground);
  EXPECT_NEAR(ahead.lon_deg * mars::kRadiansPerDegree * (kR + 1000), full * 0.1, 1e-4);
  EXPECT_NEAR(ahead.lat_deg, 0, 1e-12);
  const Pose south = steered(start, {.right = 1}, 0.1, ground);
  EXPECT_LT(south.lat_deg, 0);
  // Straight down, forward is down; rolled by 90 degrees, up is right.
  EXPECT_NEAR(steered({0, 0, 1000, 0, -90, 0}, {.forward = 1}, 0.1, ground).alt_m, 930, 1e-9);
  EXPECT_GT(steered({0, 0, 1000, 0, 0, 90}, {.up = 1}, 0.1, ground).lon_deg, 0);
  EXPECT_NEAR(steered(start, {.yaw_right = 1}, 0.1, ground).yaw_deg, 94.5, 1e-12);
  EXPECT_NEAR(steered(start, {.pitch_up = 1}, 100, ground).pitch_deg, 4.5,
              1e-12);  // a frame counts 0.1 s at most
  EXPECT_EQ(steered(start, {}, 0.1, ground).lon_deg, start.lon_deg);
}

TEST(Steer, PitchEndsAtTheZenith) {
  EXPECT_EQ(rotated({0, 0, 0, 0, 80, 0}, 0, 30, 0).pitch_deg, 90);
  EXPECT_EQ(rotated({0, 0, 0, 170, 0, 0}, 20, 0, 0).yaw_deg, -170);
  EXPECT_EQ(rotated({0, 0, 0, 170, 0, 0}, std::nan(""), 0, 0).yaw_deg, 170);
}

RC_GTEST_PROP(Steer, NeverBelowTheGround, ()) {
  const TerrainQuery ground = hills();
  Pose pose = kept_clear(some_pose(), ground);
  for (int n = 0; n < 20; ++n) {
    Controls controls;
    controls.forward = between(-1, 1, *rc::gen::inRange(0, 1001), 1000);
    controls.up = between(-1, 1, *rc::gen::inRange(0, 1001), 1000);
    controls.right = between(-1, 1, *rc::gen::inRange(0, 1001), 1000);
    controls.speed = 4;
    const Pose next = steered(pose, controls, 0.1, ground);
    RC_ASSERT(height_above_ground_m(next, ground) >= SteerLimits::kClearance_m * 0.999999);
    RC_ASSERT(next.alt_m <= SteerLimits::kHighest_radii * kR);
    RC_ASSERT(std::abs(next.lat_deg) <= 90.0);
    pose = next;
  }
}

TEST(Steer, PassesOverObstacles) {
  // A wall of 2 km, 100 m thick, 5 km ahead; in one long step from 50 m above the plain.
  TerrainQuery ground = ball(kR);
  const double wall_rad = 5000 / kR;
  double highest_seen = 0;
  ground.height_m = [&](const glm::dvec3& d) {
    const double east = std::atan2(d.y, d.x);
    const double height = std::abs(east - wall_rad) < 50 / kR ? 2000.0 : 0.0;
    highest_seen = std::max(highest_seen, height);
    return height;
  };
  const Pose end = moved({0, 0, 50, 90, 0, 0}, 0, 0, 8000, ground);
  EXPECT_EQ(highest_seen, 2000);  // it was met
  EXPECT_GE(end.alt_m, 2001);
}

}  // namespace
}  // namespace vpe::explore
