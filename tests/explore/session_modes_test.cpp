// Tests of the modes of motion of a session.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "scripts/flight.h"
#include "tests/explore/session_support.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

using test_support::finish;
using test_support::session_at;

const mars::Pose kOver{20, 10, 150'000, 40, -35, 0};

void hold(Session& session, const Controls& controls, int frames) {
  for (int n = 0; n < frames; ++n) session.advance(0.05, controls);
}

TEST(SessionModes, FlyKeepsItsHeightWhateverThePitch) {
  Session session = session_at(kOver);
  session.set_mode(MotionMode::kFly);
  EXPECT_FALSE(session.is_going());
  EXPECT_EQ(session.pose().alt_m, kOver.alt_m);
  hold(session, {.forward = 1}, 10);
  EXPECT_NEAR(session.pose().alt_m, kOver.alt_m, 1e-6);
  EXPECT_GT(mars::distance_rad({20, 10}, {session.pose().lon_deg, session.pose().lat_deg}) * 3396190, 10'000);
  hold(session, {.up = 1}, 10);
  EXPECT_GT(session.pose().alt_m, kOver.alt_m + 10'000);
  Session orbits = session_at(kOver);
  hold(orbits, {.forward = 1}, 10);
  EXPECT_LT(orbits.pose().alt_m, kOver.alt_m - 1000) << "orbit follows the view";
}

TEST(SessionModes, TheWheelChangesTheSpeedOfFlyingWithinItsLimits) {
  Session session = session_at(kOver);
  session.set_mode(MotionMode::kFly);
  session.wheel({640, 360}, 2);
  EXPECT_NEAR(session.mover().speed(), 1.25 * 1.25, 1e-12);
  EXPECT_FALSE(session.is_moving());
  EXPECT_EQ(session.pose().alt_m, kOver.alt_m);
  for (int n = 0; n < 100; ++n) session.wheel({640, 360}, 10);
  EXPECT_EQ(session.mover().speed(), Mover::kFastest);
  for (int n = 0; n < 100; ++n) session.wheel({640, 360}, -10);
  EXPECT_EQ(session.mover().speed(), Mover::kSlowest);
  const mars::Pose before = session.pose();
  session.advance(0.05, {.forward = 1});
  const double way_m =
      mars::distance_rad({before.lon_deg, before.lat_deg}, {session.pose().lon_deg, session.pose().lat_deg}) *
      (3396190 + before.alt_m);
  EXPECT_NEAR(way_m, full_speed_m_s(before, session.ground()) * 0.05 / 64, 0.01);
}

TEST(SessionModes, EveryDragLooksAroundInFly) {
  for (const MouseUse use : {MouseUse::kHold, MouseUse::kTilt, MouseUse::kLook}) {
    Session session = session_at(kOver);
    session.set_mode(MotionMode::kFly);
    const glm::dvec3 position_m = session.view().camera.position_m;
    session.press(use, {600, 500}, 1.0);
    EXPECT_EQ(session.mouse_use(), MouseUse::kLook);
    session.drag({500, 500}, 1.02);
    session.drag({400, 500}, 1.04);
    session.release(1.05);
    EXPECT_FALSE(session.is_moving()) << "a look is not thrown";
    EXPECT_LT(glm::length(session.view().camera.position_m - position_m), 1e-6);
    EXPECT_GT(session.pose().yaw_deg, kOver.yaw_deg + 5);
  }
}

TEST(SessionModes, WalkFliesDownAndStandsOnTheGround) {
  Session session = session_at({20, 10, 150'000, 40, -90, 3});
  session.set_mode(MotionMode::kWalk);
  EXPECT_TRUE(session.is_going());
  finish(session);
  EXPECT_NEAR(session.height_m(), WalkLimits::kEye_m, 1e-6);
  EXPECT_EQ(session.pose().roll_deg, 0);
  EXPECT_GE(session.pose().pitch_deg, -10);
  EXPECT_NEAR(session.pose().lon_deg, 20, 1e-9);
  hold(session, {.forward = 1}, 100);
  EXPECT_TRUE(session.is_moving());
  finish(session);
  EXPECT_NEAR(session.height_m(), WalkLimits::kEye_m, 1e-6);
  const double way_m = mars::distance_rad({20, 10}, {session.pose().lon_deg, session.pose().lat_deg}) * 3396190;
  EXPECT_GT(way_m, 5);
  EXPECT_LT(way_m, 9);
  session.wheel({640, 360}, 1);
  EXPECT_NEAR(session.screen().fov_deg, 40, 1e-9) << "the wheel is a field glass";
}

TEST(SessionModes, TheWalkerFollowsTheExaggeration) {
  Session session = session_at(kOver);
  session.set_mode(MotionMode::kWalk);
  finish(session);
  ASSERT_EQ(session.set("exaggeration", "5"), "");
  EXPECT_NEAR(session.height_m(), WalkLimits::kEye_m, 1e-6);
  session.advance(0.02, {});
  EXPECT_NEAR(session.height_m(), WalkLimits::kEye_m, 1e-6);
}

TEST(SessionModes, DriveHasTheAttitudeOfTheGroundAndLooksFromThere) {
  Session session = session_at(kOver);
  session.set_mode(MotionMode::kDrive);
  finish(session);
  hold(session, {.forward = 1}, 60);
  EXPECT_TRUE(session.is_moving());
  ASSERT_NE(session.mover().contact(), nullptr);
  const Contact contact = *session.mover().contact();
  EXPECT_EQ(session.pose().pitch_deg, contact.pitch_deg);
  EXPECT_EQ(session.pose().roll_deg, contact.roll_deg);
  EXPECT_GE(session.height_m(), session.mover().vehicle_options().mast_m - 1e-6);
  finish(session);
  // Looking around leaves the vehicle alone.
  const mars::Pose stands = session.pose();
  session.press(MouseUse::kHold, {600, 360});
  session.drag({400, 360});
  session.release();
  EXPECT_EQ(session.pose().yaw_deg, stands.yaw_deg);
  EXPECT_GT(session.look().yaw_deg, 5);
  session.advance(0.02, {});
  EXPECT_GT(session.look().yaw_deg, 5);
  // The view stays when the driver gets off.
  const glm::dvec3 forward = session.view().camera.axes.forward;
  session.set_mode(MotionMode::kOrbit);
  session.advance(0.02, {});
  EXPECT_LT(mars::angle_between_rad(forward, session.view().camera.axes.forward), 1e-9);
}

TEST(SessionModes, ADoubleClickGoesThereOnFoot) {
  Session session = session_at({20, 10, 150'000, 40, -90, 0});
  session.set_mode(MotionMode::kWalk);
  finish(session);
  session.look_by(0, 400);
  const auto point = ground_at(session.pose(), session.screen(), {700, 500}, session.ground());
  ASSERT_TRUE(point.has_value());
  session.fly_towards({700, 500});
  finish(session);
  EXPECT_EQ(session.mode(), MotionMode::kWalk);
  EXPECT_NEAR(session.height_m(), WalkLimits::kEye_m, 1e-6);
  const mars::LonLat place = mars::lon_lat(*point);
  EXPECT_NEAR(session.pose().lon_deg, place.lon_deg, 1e-9);
}

TEST(SessionModes, AViewFromHighAboveEndsWalkAndDrive) {
  for (const MotionMode mode : {MotionMode::kWalk, MotionMode::kDrive}) {
    Session session = session_at(kOver);
    session.set_mode(mode);
    finish(session);
    session.show_planet();
    finish(session);
    EXPECT_EQ(session.mode(), MotionMode::kOrbit);
    EXPECT_GT(session.height_m(), 1e6);
    session.set_mode(mode);
    session.put(kOver);
    EXPECT_EQ(session.mode(), MotionMode::kOrbit);
    EXPECT_EQ(session.pose().alt_m, kOver.alt_m);
  }
}

TEST(SessionModes, AFlightEndsWalkAndAModeEndsAFlight) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().append(kOver, 1000), "");
  mars::Pose other = kOver;
  other.lon_deg += 1;
  ASSERT_EQ(session.flights().append(other, 1000), "");
  session.set_mode(MotionMode::kWalk);
  finish(session);
  ASSERT_EQ(session.follow(true), "");
  EXPECT_EQ(session.mode(), MotionMode::kOrbit);
  session.set_mode(MotionMode::kFly);
  EXPECT_FALSE(session.follows_flight());
  EXPECT_EQ(session.mode(), MotionMode::kFly);
}

TEST(SessionModes, BadVehiclesAreRefused) {
  SessionOptions options;
  options.vehicle.wheels = 3;
  EXPECT_THROW(Session(test_support::session_surface(), options), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::explore
