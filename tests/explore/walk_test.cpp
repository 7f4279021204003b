#include "vpe/explore/walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/explore/terrain_support.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

constexpr double kR = mars::kMarsRadius_m;

double eye_height_m(const Walker& walker, const TerrainQuery& ground) {
  return height_above_ground_m(walker.pose, ground);
}

Walker at_origin(double yaw_deg, const TerrainQuery& ground) {
  return {standing({0, 0, 0, yaw_deg, 0, 0}, ground)};
}

// Walks until the speed has settled, then returns it.
double speed_on(double slope, double factor = 1) {
  const TerrainQuery ground = sloping_ground(slope, 0);
  Walker walker = at_origin(90, ground);
  for (int n = 0; n < 100; ++n) walker = walked(walker, {.forward = 1, .speed = factor}, 0.02, ground);
  return walker.velocity_m_s.y;
}

// The figures are those of Tobler's function (6 km/h at a fall of 5 %), not of this program.
TEST(Walk, TheSpeedIsToblers) {
  EXPECT_NEAR(stride_m_s(0), 1.4, 0.002);
  EXPECT_NEAR(stride_m_s(-0.05), 6 / 3.6, 1e-12);
  EXPECT_NEAR(stride_m_s(0.1), 6 / 3.6 * std::exp(-0.525), 1e-12);
  EXPECT_EQ(stride_m_s(std::tan(36 * mars::kRadiansPerDegree)), 0);
  EXPECT_EQ(stride_m_s(-3), WalkLimits::kScramble_m_s);
  EXPECT_NEAR(speed_on(0), 1.4, 0.005);
  EXPECT_NEAR(speed_on(0, 4), 5.6, 0.02);
  EXPECT_NEAR(speed_on(0.2), stride_m_s(0.2), 1e-3);
  EXPECT_NEAR(speed_on(-0.2), stride_m_s(-0.2), 1e-3);
}

TEST(Walk, AMinuteOfWalkingIsAsLongAsItsSpeedSays) {
  const TerrainQuery ground = ball(kR);
  Walker walker = at_origin(90, ground);
  for (int n = 0; n < 60 * 50; ++n) walker = walked(walker, {.forward = 1}, 0.02, ground);
  EXPECT_NEAR(walker.pose.lon_deg * mars::kRadiansPerDegree * kR, 84, 1);
  EXPECT_NEAR(walker.pose.lat_deg, 0, 1e-9);
  EXPECT_NEAR(eye_height_m(walker, ground), WalkLimits::kEye_m, 1e-9);
}

TEST(Walk, PitchDoesNotSinkTheEye) {
  const TerrainQuery ground = ball(kR);
  Walker walker = at_origin(0, ground);
  walker.pose.pitch_deg = -80;
  for (int n = 0; n < 100; ++n) walker = walked(walker, {.forward = 1}, 0.02, ground);
  EXPECT_NEAR(eye_height_m(walker, ground), WalkLimits::kEye_m, 1e-6);
  EXPECT_GT(walker.pose.lat_deg * mars::kRadiansPerDegree * kR, 2.4);
  EXPECT_EQ(walker.pose.pitch_deg, -80);
}

TEST(Walk, ASlopeThatIsTooSteepStopsByAndBy) {
  TerrainQuery ground = ball(kR);
  // Level to 3 m in the east, then 45 degrees upwards.
  ground.height_m = [](const glm::dvec3& d) { return std::max(0.0, std::atan2(d.y, d.x) * kR - 3.0); };
  Walker walker = at_origin(90, ground);
  double before = 0;
  bool slides = false;
  for (int n = 0; n < 400; ++n) {
    walker = walked(walker, {.forward = 1, .speed = 4}, 0.02, ground);
    slides = slides || (walker.is_blocked && walker.velocity_m_s.y > 0.5 && walker.velocity_m_s.y < before);
    before = walker.velocity_m_s.y;
    ASSERT_GE(eye_height_m(walker, ground), WalkLimits::kLeastEye_m);
  }
  EXPECT_TRUE(slides);
  EXPECT_TRUE(walker.is_blocked);
  EXPECT_LT(walker.velocity_m_s.y, 0.01);
  const double east_m = walker.pose.lon_deg * mars::kRadiansPerDegree * kR;
  EXPECT_GT(east_m, 2);
  EXPECT_LT(east_m, 5);
  for (int n = 0; n < 100; ++n) walker = walked(walker, {.forward = -1}, 0.02, ground);
  EXPECT_LT(walker.pose.lon_deg * mars::kRadiansPerDegree * kR, east_m - 1) << "there is a way back";
}

TEST(Walk, ComesToRestAndIsThenStill) {
  const TerrainQuery ground = rough_ground();
  Walker walker = at_origin(30, ground);
  for (int n = 0; n < 50; ++n) walker = walked(walker, {.forward = 1, .speed = 4}, 0.02, ground);
  EXPECT_TRUE(is_moving(walker));
  int frames = 0;
  for (; frames < 200 && is_moving(walker); ++frames) walker = walked(walker, {}, 0.02, ground);
  EXPECT_LT(frames, 100);
  const Walker still = walked(walker, {}, 0.02, ground);
  EXPECT_EQ(still.pose.lon_deg, walker.pose.lon_deg);
  EXPECT_EQ(still.pose.alt_m, walker.pose.alt_m);
  EXPECT_NEAR(eye_height_m(still, ground), WalkLimits::kEye_m, 1e-9);
}

TEST(Walk, TheEyeFollowsTheGroundSmoothly) {
  const TerrainQuery ground = rough_ground();
  Walker walker = at_origin(0, ground);
  double steepest = 0;
  for (int n = 0; n < 2000; ++n) {
    const double before_m = walker.pose.alt_m;
    walker = walked(walker, {.forward = 1}, 1.0 / 60, ground);
    steepest = std::max(steepest, std::abs(walker.pose.alt_m - before_m));
  }
  EXPECT_LT(steepest, 0.6) << "a step of the ground is not one of the eye";
}

TEST(Walk, NeverBelowTheGroundInRandomTracks) {
  const TerrainQuery ground = rough_ground();
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> unit(-1, 1);
  double lowest_m = 1e9;
  for (int track = 0; track < 10'000; ++track) {
    const double lon_deg = 180 * unit(random);
    const double lat_deg = 90 * unit(random);
    const double yaw_deg = 180 * unit(random);
    Walker walker{standing({lon_deg, lat_deg, 0, yaw_deg, 0, 0}, ground)};
    Controls controls;
    controls.forward = unit(random);
    controls.right = unit(random);
    controls.yaw_right = unit(random);
    controls.speed = std::pow(10.0, 2 * unit(random));
    for (int step = 0; step < 40; ++step) {
      const double dt_s = 0.06 + 0.05 * unit(random);
      walker = walked(walker, step < 30 ? controls : Controls{}, dt_s, ground);
      lowest_m = std::min(lowest_m, eye_height_m(walker, ground));
    }
    ASSERT_TRUE(std::isfinite(walker.pose.alt_m) && std::abs(walker.pose.lat_deg) <= 90);
  }
  EXPECT_GE(lowest_m, WalkLimits::kLeastEye_m - 1e-6);
  EXPECT_LT(lowest_m, 1.2) << "the limit was needed";
}

TEST(Walk, AStepAsksTheGroundAtMostThreeTimes) {
  int queries = 0;
  TerrainQuery ground = rough_ground();
  ground.height_m = [&queries, height_m = ground.height_m](const glm::dvec3& d) {
    ++queries;
    return height_m(d);
  };
  Walker walker = at_origin(0, ground);
  queries = 0;
  for (int n = 0; n < 100; ++n) walker = walked(walker, {.forward = 1}, 0.02, ground);
  EXPECT_LE(queries, 300);
  EXPECT_GE(queries, 100);
  while (is_moving(walker)) walker = walked(walker, {}, 0.02, ground);
  queries = 0;
  walker = walked(walker, {}, 0.02, ground);
  EXPECT_EQ(queries, 0);
}

TEST(Walk, RatesThatAreNotNumbersAreHarmless) {
  const TerrainQuery ground = ball(kR);
  Walker walker = at_origin(0, ground);
  for (const double dt_s : {0.0, -1.0, std::nan("")}) {
    const Walker same = walked(walker, {.forward = 1}, dt_s, ground);
    EXPECT_EQ(same.pose.lat_deg, walker.pose.lat_deg) << dt_s;
  }
  walker = walked(walker, {.forward = 1}, 1e9, ground);
  EXPECT_LT(walker.pose.lat_deg * mars::kRadiansPerDegree * kR, 1) << "a long frame counts a tenth of a second";
}

}  // namespace
}  // namespace vpe::explore
