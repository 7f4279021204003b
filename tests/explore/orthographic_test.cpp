#include "vpe/explore/orthographic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/explore/session_support.h"
#include "tests/explore/terrain_support.h"
#include "tests/support/support.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

using test_support::finish;
using test_support::Random;
using test_support::session_at;

constexpr double kHalfView_rad = 0.5 * kOrthographicFov_deg * mars::kRadiansPerDegree;

glm::dvec3 middle_m(const Session& session) {
  return ground_at(session.pose(), session.screen(), {640, 360}, session.ground()).value();
}

TEST(Orthographic, TheMiddleKeepsItsPlaceAndSize) {
  Random random(1);
  const TerrainQuery ground = ball(mars::kMarsRadius_m);
  const Screen screen{1280, 720, 50};
  Screen far_screen = screen;
  far_screen.fov_deg = kOrthographicFov_deg;
  for (int n = 0; n < 200; ++n) {
    const mars::Pose pose{random.uniform(-180, 180), random.uniform(-89, 89),  random.log_uniform(100, 3e6),
                          random.uniform(-180, 180), random.uniform(-90, -75), random.uniform(-180, 180)};
    const auto at = at_same_size(pose, screen, kOrthographicFov_deg, ground);
    ASSERT_TRUE(at.has_value());
    const glm::dvec3 before = ground_at(pose, screen, {640, 360}, ground).value();
    const double shown_m = shown_height_m(pose, screen, ground).value();
    const core::View view = view_of(*at, far_screen, ground.radius_m);
    const core::Projected middle = core::project(view, before);
    // Positions at a thousand radii are rounded to micrometres.
    EXPECT_NEAR(middle.xy.x, 640, 0.01) << n;
    EXPECT_NEAR(middle.xy.y, 360, 0.01) << n;
    EXPECT_NEAR(shown_height_m(*at, far_screen, ground).value(), shown_m, 1e-6 * shown_m) << n;
    const auto back = at_same_size(*at, far_screen, screen.fov_deg, ground);
    ASSERT_TRUE(back.has_value());
    EXPECT_LT(glm::length(mars::to_camera(*back, ground.radius_m).position_m -
                          mars::to_camera(pose, ground.radius_m).position_m),
              1e-6 * shown_m + 0.01)
        << n;
  }
  EXPECT_FALSE(at_same_size({0, 0, 1000, 0, 20, 0}, screen, kOrthographicFov_deg, ground).has_value());
  EXPECT_FALSE(shown_height_m({0, 0, 1000, 0, 20, 0}, screen, ground).has_value());
}

// Compares with parallel rays, computed here.
TEST(Orthographic, PointsLieWithinTheStatedShiftOfAParallelProjection) {
  Random random(2);
  Screen screen{1280, 720, kOrthographicFov_deg};
  const TerrainQuery ground = ball(mars::kMarsRadius_m);
  double worst_share = 0;
  for (int n = 0; n < 2000; ++n) {
    const mars::Pose low{random.uniform(-180, 180), random.uniform(-80, 80),  random.log_uniform(1000, 1e6),
                         random.uniform(-180, 180), random.uniform(-90, -60), 0};
    const mars::Pose pose = at_same_size(low, {1280, 720, 50}, kOrthographicFov_deg, ground).value();
    const glm::dvec3 middle = ground_at(pose, screen, {640, 360}, ground).value();
    const double shown_m = shown_height_m(pose, screen, ground).value();
    const core::View view = view_of(pose, screen, ground.radius_m);
    const double m_px = shown_m / screen.height;
    const glm::dvec2 offset_px{random.uniform(-640, 640), random.uniform(-360, 360)};
    const double depth_m = random.uniform(-0.5, 0.5) * shown_m;
    const auto& axes = view.camera.axes;
    const glm::dvec3 point =
        middle + (axes.right * offset_px.x - axes.up * offset_px.y) * m_px + axes.forward * depth_m;
    const double shift_px = glm::length(core::project(view, point).xy - (glm::dvec2{640, 360} + offset_px));
    const double bound_px = parallel_shift_px(screen, shown_m, depth_m);
    EXPECT_LE(shift_px, bound_px + 0.01) << n;
    worst_share = std::max(worst_share, shift_px / (bound_px + 0.01));
  }
  EXPECT_GT(worst_share, 0.5);  // the bound is not idle
  EXPECT_NEAR(parallel_shift_px(screen, 1000, 100), 0.13, 0.005);
  EXPECT_EQ(parallel_shift_px(screen, 1000, 1e9), std::numeric_limits<double>::infinity());
}

TEST(Orthographic, TheHighestAltitudeShowsAsMuchAsFromTenRadii) {
  EXPECT_EQ(highest_radii(50), SteerLimits::kHighest_radii);
  EXPECT_EQ(highest_radii(1), SteerLimits::kHighest_radii);
  EXPECT_NEAR(highest_radii(kOrthographicFov_deg) * std::tan(kHalfView_rad),
              SteerLimits::kHighest_radii * std::tan(25 * mars::kRadiansPerDegree), 1e-9);
  EXPECT_TRUE(is_orthographic(kOrthographicFov_deg));
  EXPECT_FALSE(is_orthographic(1));
}

TEST(Orthographic, ASessionChangesToItAndBack) {
  Session session = session_at({10, 20, 50'000, 30, -70, 0});
  const glm::dvec3 middle = middle_m(session);
  const double shown_m = shown_height_m(session.pose(), session.screen(), session.ground()).value();
  ASSERT_EQ(session.set_orthographic(true), "");
  EXPECT_TRUE(session.is_orthographic());
  EXPECT_LT(glm::length(middle_m(session) - middle), 1);
  EXPECT_NEAR(shown_height_m(session.pose(), session.screen(), session.ground()).value(), shown_m,
              1e-3 * shown_m);
  EXPECT_EQ(session.set_orthographic(true), "");
  ASSERT_EQ(session.set_orthographic(false), "");
  EXPECT_EQ(session.screen().fov_deg, 50);
  EXPECT_LT(glm::length(middle_m(session) - middle), 5);
  EXPECT_NEAR(session.pose().alt_m, 50'000, 5);
  EXPECT_NEAR(session.pose().yaw_deg, 30, 1e-3);
}

TEST(Orthographic, IsRefusedWhereTheMiddleShowsSky) {
  Session session = session_at({10, 20, 50'000, 30, 10, 0});
  EXPECT_NE(session.set_orthographic(true).find("sky"), std::string::npos);
  EXPECT_EQ(session.screen().fov_deg, 50);
}

TEST(Orthographic, ZoomKeysAndTheWheelChangeWhatIsSeenAndNotTheAngle) {
  Session session = session_at({10, 20, 50'000, 0, -90, 0});
  ASSERT_EQ(session.set_orthographic(true), "");
  const double shown_m = shown_height_m(session.pose(), session.screen(), session.ground()).value();
  session.zoom(0.5);
  EXPECT_NEAR(shown_height_m(session.pose(), session.screen(), session.ground()).value(), shown_m / 2,
              0.01 * shown_m);
  const glm::dvec3 held = ground_at(session.pose(), session.screen(), {900, 100}, session.ground()).value();
  session.wheel({900, 100}, -2);
  finish(session);
  EXPECT_TRUE(session.is_orthographic());
  const core::Projected now = core::project(session.view(), held);
  EXPECT_NEAR(now.xy.x, 900, 0.5);
  EXPECT_NEAR(now.xy.y, 100, 0.5);
  EXPECT_NEAR(session.pose().pitch_deg, -90, 1e-6);  // no tilt on arrival
  session.zoom(std::numeric_limits<double>::quiet_NaN());
  session.zoom(-1);
  EXPECT_TRUE(session.is_orthographic());
}

TEST(Orthographic, KeysMoveByWhatIsSeenAndTurnAboutTheMiddle) {
  Session session = session_at({10, 20, 50'000, 0, -90, 0});
  ASSERT_EQ(session.set_orthographic(true), "");
  const double shown_m = shown_height_m(session.pose(), session.screen(), session.ground()).value();
  const glm::dvec3 before = middle_m(session);
  session.advance(0.1, {.right = 1});
  const double way_m = glm::length(middle_m(session) - before);
  EXPECT_GT(way_m, 0.01 * shown_m);
  EXPECT_LT(way_m, 0.2 * shown_m);
  const glm::dvec3 middle = middle_m(session);
  for (int n = 0; n < 5; ++n) session.advance(0.1, {.yaw_right = 1, .pitch_up = 1});
  EXPECT_LT(glm::length(middle_m(session) - middle), 0.01 * shown_m);
  const glm::dvec3 up = glm::normalize(middle);
  EXPECT_LT(std::abs(glm::dot(session.view().camera.axes.forward, up)), std::cos(15 * mars::kRadiansPerDegree));
}

TEST(Orthographic, ShowsTheWholePlanetAndGoesToPlaces) {
  Session session = session_at({10, 20, 50'000, 0, -90, 0});
  ASSERT_EQ(session.set_orthographic(true), "");
  session.go_to({12, 21});
  finish(session);
  const mars::LonLat place = mars::lon_lat(middle_m(session));
  EXPECT_NEAR(place.lon_deg, 12, 1e-3);
  EXPECT_NEAR(place.lat_deg, 21, 1e-3);
  session.show_planet();
  finish(session);
  EXPECT_TRUE(session.is_orthographic());
  const double radius_m = session.ground().radius_m;
  const core::View view = session.view();
  const double focal = core::focal_px(view);
  const double rim_px = focal * std::tan(std::asin(radius_m / (radius_m + session.pose().alt_m)));
  EXPECT_NEAR(rim_px, 0.9 * 360, 10);
}

TEST(Orthographic, EndsWithTheModesOfMotionOnTheGround) {
  Session session = session_at({10, 20, 50'000, 0, -90, 0});
  ASSERT_EQ(session.set_orthographic(true), "");
  session.set_mode(MotionMode::kWalk);
  finish(session);
  EXPECT_FALSE(session.is_orthographic());
  EXPECT_EQ(session.mode(), MotionMode::kWalk);
  EXPECT_LT(session.height_m(), 10);
  session.set_mode(MotionMode::kOrbit);
  session.put({10, 20, 50'000, 0, -90, 0});
  ASSERT_EQ(session.set_orthographic(true), "");
  session.set_mode(MotionMode::kFly);
  EXPECT_FALSE(session.is_orthographic());
}

}  // namespace
}  // namespace vpe::explore
