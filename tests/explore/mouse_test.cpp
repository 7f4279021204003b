#include "vpe/explore/mouse.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/explore/terrain_support.h"
#include "vpe/explore/fly_to.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

using mars::Pose;

constexpr double kR = mars::kMarsRadius_m;
const Screen kScreen{1280, 720, 50};

double off_px(const Pose& pose, const glm::dvec3& point, glm::dvec2 xy) {
  const core::Projected at = core::project(view_of(pose, kScreen, kR), point);
  return at.behind ? 1e9 : glm::length(at.xy - xy);
}

struct Case {
  const char* name;
  Pose pose;
};
const Case kCases[] = {
    {"orbit", {-59, -13, 9e6, 0, -90, 0}},          {"high", {30, 20, 200'000, 40, -60, 0}},
    {"oblique", {137, -5, 8000, 160, -25, 0}},      {"low", {137, -5, 300, -20, -15, 0}},
    {"near a pole", {10, 89.5, 50'000, 0, -70, 0}}, {"across 180", {179.9, 5, 100'000, 0, -50, 0}},
    {"rolled", {0, 0, 20'000, 10, -40, 30}},        {"down, rolled", {0, 0, 20'000, 10, -90, 30}},
};

TEST(Mouse, DraggedGroundStaysUnderTheCursor) {
  const TerrainQuery ground = ball(kR);
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const auto held = ground_at(c.pose, kScreen, {640, 400}, ground);
    ASSERT_TRUE(held.has_value());
    for (const glm::dvec2 to : {glm::dvec2{700, 420}, {500, 500}, {640, 380}}) {
      const Pose end = dragged(c.pose, kScreen, *held, to, ground);
      EXPECT_LT(off_px(end, *held, to), 1e-6) << to.x << "," << to.y;
      EXPECT_NEAR(end.alt_m, c.pose.alt_m, 1e-6);
      EXPECT_EQ(end.pitch_deg, c.pose.pitch_deg);
      EXPECT_EQ(end.roll_deg, c.pose.roll_deg);
      if (std::abs(c.pose.lat_deg) < 60) {
        EXPECT_EQ(end.yaw_deg, c.pose.yaw_deg);
      }
    }
  }
}

TEST(Mouse, DraggingEastShowsTheWest) {
  const TerrainQuery ground = ball(kR);
  const Pose pose{20, 0, 500'000, 0, -90, 0};
  const auto held = ground_at(pose, kScreen, {640, 360}, ground);
  const Pose end = dragged(pose, kScreen, *held, {840, 360}, ground);
  EXPECT_LT(end.lon_deg, 20);
  const Pose up = dragged(pose, kScreen, *held, {640, 260}, ground);
  EXPECT_LT(up.lat_deg, 0);
}

TEST(Mouse, ADragBeyondTheEdgeHoldsTheEdge) {
  const TerrainQuery ground = ball(kR);
  const Pose pose{20, 0, 9e6, 0, -90, 0};
  const auto held = ground_at(pose, kScreen, {640, 360}, ground);
  const Pose end = dragged(pose, kScreen, *held, {1270, 360}, ground);
  EXPECT_TRUE(std::isfinite(end.lon_deg));
  EXPECT_LT(end.lon_deg, -20);
}

TEST(Mouse, ZoomKeepsTheGroundUnderTheCursor) {
  const TerrainQuery ground = ball(kR);
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    for (const double factor : {0.8, 0.5, 1.25}) {
      const glm::dvec2 xy{740, 440};
      const auto point = ground_at(c.pose, kScreen, xy, ground);
      ASSERT_TRUE(point.has_value());
      const Pose end = zoomed(c.pose, kScreen, xy, factor, ground);
      if (end.alt_m > SteerLimits::kHighest_radii * kR * 0.99) continue;
      EXPECT_LT(off_px(end, *point, xy), 1e-5);
      const double before = glm::length(mars::to_camera(c.pose, kR).position_m - *point);
      const double after = glm::length(mars::to_camera(end, kR).position_m - *point);
      EXPECT_NEAR(after / before, factor, c.pose.alt_m > 1e6 ? 0.25 : 0.02);
    }
  }
}

TEST(Mouse, ZoomingInEndsAboveTheGround) {
  const TerrainQuery ground = hills();
  Pose pose{5, 5, 400'000, 0, -70, 0};
  for (int n = 0; n < 200; ++n) pose = zoomed(pose, kScreen, {640, 360}, 0.8, ground);
  EXPECT_GE(height_above_ground_m(pose, ground), SteerLimits::kClearance_m * 0.999);
  EXPECT_LT(height_above_ground_m(pose, ground), 10);
  for (int n = 0; n < 200; ++n) pose = zoomed(pose, kScreen, {640, 360}, 1.25, ground);
  EXPECT_LE(pose.alt_m, SteerLimits::kHighest_radii * kR);
  EXPECT_GT(pose.alt_m, kR);
}

TEST(Mouse, TiltRotatesAboutTheMiddle) {
  const TerrainQuery ground = ball(kR);
  for (const Case& c : kCases) {
    if (c.pose.roll_deg != 0) continue;
    SCOPED_TRACE(c.name);
    const auto pivot = ground_at(c.pose, kScreen, {640, 360}, ground);
    ASSERT_TRUE(pivot.has_value());
    const double distance = glm::length(mars::to_camera(c.pose, kR).position_m - *pivot);
    for (const glm::dvec2 turn : {glm::dvec2{20, 0}, {-35, 5}, {0, -10}}) {
      const Pose end = tilted(c.pose, kScreen, turn.x, turn.y, ground);
      EXPECT_LT(off_px(end, *pivot, {640, 360}), 1e-5);
      EXPECT_NEAR(glm::length(mars::to_camera(end, kR).position_m - *pivot) / distance, 1, 1e-9);
      EXPECT_NEAR(end.roll_deg, 0, 1e-5);
    }
  }
}

TEST(Mouse, TiltInTheSkyRotatesInPlace) {
  const Pose end = tilted({0, 0, 1000, 0, 30, 0}, kScreen, 10, 5, ball(kR));
  EXPECT_NEAR(end.yaw_deg, 10, 1e-12);
  EXPECT_NEAR(end.pitch_deg, 25, 1e-12);
}

TEST(Mouse, OverviewShowsTheWholePlanet) {
  for (const Screen screen : {Screen{1280, 720, 50}, Screen{600, 1200, 60}}) {
    const Pose pose = overview({-59, 20}, screen, kR);
    for (const glm::dvec2 xy : {glm::dvec2{1, 1}, {screen.width / 2.0, 1}, {1, screen.height / 2.0}})
      EXPECT_FALSE(ground_at(pose, screen, xy, ball(kR)).has_value());
    EXPECT_TRUE(ground_at(pose, screen, {screen.width / 2.0, screen.height / 2.0}, ball(kR)).has_value());
  }
}

TEST(Mouse, LookingAtAPlaceHasItInTheMiddle) {
  const TerrainQuery ground = ball(kR);
  const Pose pose{0, 0, 5000, 70, -10, 0};
  const glm::dvec3 point = mars::direction({3, 4}) * kR;
  const Pose end = looking_at(pose, point, 20'000, ground);
  EXPECT_LT(off_px(end, point, {640, 360}), 1e-5);
  EXPECT_NEAR(glm::length(mars::to_camera(end, kR).position_m - point), 20'000, 1e-3);
}

TEST(FlyTo, BeginsAndEndsAtItsPoses) {
  const TerrainQuery ground = hills();
  const Pose from = kept_clear({10, 20, 4000, 350, -20, 10}, ground);
  const Pose to = kept_clear({-170, -40, 90'000, 20, -80, -10}, ground);
  const FlyTo way(from, to, ground);
  EXPECT_LE(way.duration_s(), FlyToLimits::kLongest_s);
  EXPECT_NEAR(way.at(0, ground).lon_deg, from.lon_deg, 1e-9);
  EXPECT_NEAR(way.at(0, ground).alt_m, from.alt_m, 1e-6);
  EXPECT_EQ(way.at(way.duration_s(), ground).lon_deg, to.lon_deg);
  EXPECT_EQ(way.at(1e9, ground).alt_m, to.alt_m);
  Pose before = way.at(0, ground);
  for (int n = 1; n <= 400; ++n) {
    const Pose now = way.at(way.duration_s() * n / 400.0, ground);
    EXPECT_GE(height_above_ground_m(now, ground), SteerLimits::kClearance_m * 0.999);
    EXPECT_LT(mars::distance_rad({before.lon_deg, before.lat_deg}, {now.lon_deg, now.lat_deg}), 0.03);
    before = now;
  }
}

}  // namespace
}  // namespace vpe::explore
