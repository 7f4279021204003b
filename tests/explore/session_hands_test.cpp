// Tests of the hands of a session: throws, the eased wheel, the tilt on arrival, looking around in place.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "scripts/flight.h"
#include "tests/explore/session_support.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

using test_support::finish;
using test_support::session_at;

const mars::Pose kOver{20, 10, 150'000, 40, -35, 0};
const mars::Pose kAbove{20, 10, 150'000, 0, -90, 0};

double way_rad(const mars::Pose& a, const mars::Pose& b) {
  return mars::distance_rad({a.lon_deg, a.lat_deg}, {b.lon_deg, b.lat_deg});
}

// Drags by 20 pixels each 20 ms.
double drag(Session& session, double step_px = 20) {
  double time_s = 100;
  session.press(MouseUse::kHold, {600, 400}, time_s);
  for (int n = 1; n <= 10; ++n) session.drag({600 + step_px * n, 400}, time_s += 0.02);
  return time_s;
}

TEST(SessionThrow, GoesOnAndDiesOffInHalfASecond) {
  Session session = session_at(kAbove);
  const double end_s = drag(session);
  const mars::Pose last = session.pose();
  const double step_rad = way_rad(kAbove, last) / 10;
  session.release(end_s + 0.01);
  EXPECT_TRUE(session.is_moving());
  EXPECT_FALSE(session.is_going());
  double before_rad = 0;
  double slower_rad = step_rad * 1.05;
  int frames = 0;
  for (; frames < 100 && session.is_moving(); ++frames) {
    session.advance(0.02, {});
    const double rad = way_rad(last, session.pose());
    EXPECT_GE(rad - before_rad, -1e-12);
    EXPECT_LE(rad - before_rad, slower_rad + 1e-12) << "frame " << frames;
    slower_rad = rad - before_rad;
    before_rad = rad;
  }
  EXPECT_NEAR(frames * 0.02, ThrowLimits::kTime_s, 0.021);
  // A sixth of a second at the speed of the drag, of 50 steps a second.
  EXPECT_NEAR(before_rad, step_rad * 50 / 6, 0.1 * before_rad);
  EXPECT_LT(slower_rad, 0.05 * step_rad);
  const mars::Pose rest = session.pose();
  session.advance(0.02, {});
  EXPECT_EQ(rest.lon_deg, session.pose().lon_deg);
}

TEST(SessionThrow, DoesNotDependOnTheLengthOfFrames) {
  std::vector<mars::Pose> ends;
  for (const double dt_s : {0.005, 0.07}) {
    Session session = session_at(kAbove);
    session.release(drag(session));
    for (int n = 0; n < 1000 && session.is_moving(); ++n) session.advance(dt_s, {});
    ends.push_back(session.pose());
  }
  EXPECT_EQ(ends[0].lon_deg, ends[1].lon_deg);
  EXPECT_EQ(ends[0].lat_deg, ends[1].lat_deg);
}

TEST(SessionThrow, ARestASlowDragAndNoTimesThrowNothing) {
  Session rested = session_at(kAbove);
  rested.release(drag(rested) + 0.11);
  EXPECT_FALSE(rested.is_moving());
  Session slow = session_at(kAbove);
  slow.release(drag(slow, 1));
  EXPECT_FALSE(slow.is_moving());
  Session untimed = session_at(kAbove);
  untimed.press(MouseUse::kHold, {600, 400});
  for (int n = 1; n <= 10; ++n) untimed.drag({600 + 20.0 * n, 400});
  untimed.release();
  EXPECT_FALSE(untimed.is_moving());
  Session jerked = session_at(kAbove);
  jerked.press(MouseUse::kHold, {600, 400}, 1.0);
  jerked.drag({605, 400}, 1.02);
  jerked.release(1.03);
  EXPECT_FALSE(jerked.is_moving()) << "the hand trembles in a click";
  Session clicked = session_at(kAbove);
  clicked.press(MouseUse::kHold, {600, 400}, 1.0);
  clicked.release(1.05);
  EXPECT_FALSE(clicked.is_moving());
}

TEST(SessionThrow, IsSwitchedOffByItsOption) {
  SessionOptions options;
  options.start = kAbove;
  options.mouse.throws = false;
  Session session(test_support::session_surface(), options);
  session.resize(1280, 720);
  session.release(drag(session));
  EXPECT_FALSE(session.is_moving());
}

TEST(SessionThrow, AnyInputStopsIt) {
  const std::vector<void (*)(Session&)> inputs{
      [](Session& s) {
        s.press(MouseUse::kHold, {300, 300}, 200.0);
      },
      [](Session& s) { s.stop(); },
      [](Session& s) { s.put(kOver); },
      [](Session& s) { s.set_mode(MotionMode::kFly); },
      [](Session& s) { s.advance(0.02, {.yaw_right = 1}); },
  };
  for (const auto& input : inputs) {
    Session session = session_at(kAbove);
    session.release(drag(session));
    session.advance(0.02, {});
    ASSERT_TRUE(session.is_moving());
    input(session);
    EXPECT_FALSE(session.is_moving());
  }
}

// Events of a slow window arrive in bunches with equal times.
TEST(SessionThrow, EventsAtTheSameTimeAreOne) {
  DragSamples samples;
  const double ppms = 1;
  for (int frame = 0; frame < 3; ++frame)
    for (int k = 0; k < 4; ++k) {
      const double x = (frame * 4 + k) * 16.0;
      samples.add(frame * 0.064, {x, 0}, {x / 1000, 0, 1e5, 0, -90, 0});
    }
  const auto motion = samples.motion(0.14, 720);
  ASSERT_TRUE(motion.has_value());
  EXPECT_NEAR((motion->now.lon_deg - motion->before.lon_deg) / motion->dt_s, 1.0 * ppms, 1e-9)
      << "1000 pixels a second";
}

TEST(SessionWheel, EndsWhereTheUnanimatedWheelEnds) {
  for (const mars::Pose& start : {kOver, mars::Pose{20, 10, 3'000'000, 0, -60, 0}}) {
    Session session = session_at(start);
    const glm::dvec2 xy{800, 450};
    mars::Pose expected = session.pose();
    for (int n = 0; n < 7; ++n) expected = zoomed(expected, session.screen(), xy, 1 / 1.35, session.ground());
    for (int n = 0; n < 7; ++n) {
      session.wheel(xy, 1);
      session.advance(0.016, {});
    }
    EXPECT_TRUE(session.is_moving());
    EXPECT_NE(session.pose().alt_m, expected.alt_m);
    finish(session);
    EXPECT_EQ(session.pose().lon_deg, expected.lon_deg);
    EXPECT_EQ(session.pose().lat_deg, expected.lat_deg);
    EXPECT_EQ(session.pose().alt_m, expected.alt_m);
    EXPECT_EQ(session.pose().yaw_deg, expected.yaw_deg);
    EXPECT_EQ(session.pose().pitch_deg, expected.pitch_deg);
  }
}

TEST(SessionWheel, ComesNearerInEachFrameAndHoldsTheGroundUnderTheCursor) {
  Session session = session_at(kOver);
  const glm::dvec2 xy{800, 450};
  const auto under = ground_at(session.pose(), session.screen(), xy, session.ground());
  ASSERT_TRUE(under.has_value());
  const auto distance_m = [&] { return glm::length(session.view().camera.position_m - *under); };
  const double before_m = distance_m();
  session.wheel(xy, 1);
  EXPECT_EQ(distance_m(), before_m) << "nothing moves before the next frame";
  double last_m = before_m;
  int frames = 0;
  for (; frames < 50 && session.is_moving(); ++frames) {
    session.advance(0.01, {});
    EXPECT_LT(distance_m(), last_m);
    last_m = distance_m();
    const core::Projected at = core::project(session.view(), *under);
    EXPECT_LT(glm::length(at.xy - xy), 0.5) << frames;
  }
  EXPECT_LE(frames * 0.01, WheelLimits::kTime_s + 0.0101);
  EXPECT_NEAR(last_m, before_m / 1.35, 0.06 * before_m);
}

TEST(SessionWheel, KeysTakeOverAtTheGoal) {
  Session session = session_at(kOver);
  Session settled = session_at(kOver);
  for (Session* s : {&session, &settled}) s->wheel({640, 360}, 3);
  finish(settled);
  session.advance(0.01, {.yaw_right = 1});
  EXPECT_FALSE(session.is_moving());
  EXPECT_EQ(session.pose().alt_m, settled.pose().alt_m);
}

TEST(SessionWheel, BadNotchesDoNothing) {
  Session session = session_at(kOver);
  for (const double notches : {0.0, std::nan(""), HUGE_VAL}) {
    session.wheel({640, 360}, notches);
    EXPECT_FALSE(session.is_moving()) << notches;
  }
}

TEST(SessionArrival, TheCurveFallsFromStraightDownTo30Degrees) {
  EXPECT_EQ(arrival_pitch_deg(1e7), -90);
  EXPECT_EQ(arrival_pitch_deg(8000), -90);
  EXPECT_EQ(arrival_pitch_deg(500), -30);
  EXPECT_EQ(arrival_pitch_deg(0), -30);
  double before = -90;
  for (double distance_m = 8000; distance_m > 500; distance_m /= 1.05) {
    EXPECT_GE(arrival_pitch_deg(distance_m), before);
    before = arrival_pitch_deg(distance_m);
  }
}

TEST(SessionArrival, TheWheelTiltsACameraFromAboveAndBack) {
  Session session = session_at({20, 10, 20'000, 25, -90, 0});
  const glm::dvec2 xy{700, 400};
  const auto under = ground_at(session.pose(), session.screen(), xy, session.ground());
  ASSERT_TRUE(under.has_value());
  double last_deg = -90;
  for (int n = 0; n < 30; ++n) {
    session.wheel(xy, 1);
    finish(session);
    EXPECT_GE(session.pose().pitch_deg, last_deg - 1e-9);
    EXPECT_LT(session.pose().pitch_deg - last_deg, 15) << "no jump";
    last_deg = session.pose().pitch_deg;
    if (session.height_m() > 100) {
      const core::Projected at = core::project(session.view(), *under);
      EXPECT_LT(glm::length(at.xy - xy), 1) << n;
    }
  }
  EXPECT_NEAR(session.pose().pitch_deg, -30, 1e-6);
  EXPECT_NEAR(session.pose().roll_deg, 0, 1e-9);
  EXPECT_NEAR(session.pose().yaw_deg, 25, 1e-6);
  for (int n = 0; n < 40 && session.height_m() < 15'000; ++n) session.wheel(xy, -1);
  for (int n = 0; n < 40; ++n) {
    session.wheel(xy, -1);
    finish(session);
  }
  EXPECT_LT(session.pose().pitch_deg, -85) << "the way back";
}

TEST(SessionArrival, AViewThatWasTiltedByHandKeepsItsPitch) {
  Session session = session_at({20, 10, 20'000, 25, -60, 0});
  for (int n = 0; n < 30; ++n) session.wheel({700, 400}, 1);
  finish(session);
  EXPECT_EQ(session.pose().pitch_deg, -60);
}

TEST(SessionArrival, IsSwitchedOffByItsOption) {
  SessionOptions options;
  options.start = mars::Pose{20, 10, 20'000, 25, -90, 0};
  options.mouse.tilt_on_arrival = false;
  Session session(test_support::session_surface(), options);
  session.resize(1280, 720);
  for (int n = 0; n < 30; ++n) session.wheel({700, 400}, 1);
  finish(session);
  EXPECT_EQ(session.pose().pitch_deg, -90);
}

TEST(SessionLook, CtrlDragLooksAroundInPlace) {
  Session session = session_at(kOver);
  const glm::dvec3 ray = core::pixel_ray(session.view(), 600, 360);
  const glm::dvec3 position_m = session.view().camera.position_m;
  session.press(MouseUse::kLook, {600, 360});
  for (int n = 1; n <= 10; ++n) session.drag({600 - 10.0 * n, 360 + 5.0 * n});
  session.release(0.5);
  EXPECT_FALSE(session.is_moving());
  EXPECT_LT(glm::length(session.view().camera.position_m - position_m), 1e-6);
  EXPECT_GT(session.pose().yaw_deg, kOver.yaw_deg + 2) << "a drag to the left looks to the right";
  EXPECT_GT(session.pose().pitch_deg, kOver.pitch_deg + 1);
  const glm::dvec3 now = core::pixel_ray(session.view(), 500, 410);
  EXPECT_LT(mars::angle_between_rad(ray, now) / mars::kRadiansPerDegree, 1) << "the direction is held";
}

TEST(SessionLook, ACaughtCursorTurnsTheView) {
  Session session = session_at(kOver);
  session.look_by(100, -50);
  EXPECT_NEAR(session.pose().yaw_deg, kOver.yaw_deg + 10, 1e-9);
  EXPECT_NEAR(session.pose().pitch_deg, kOver.pitch_deg + 5, 1e-9);
  session.look_by(std::nan(""), 0);
  session.look_by(0, -1e9);
  EXPECT_EQ(session.pose().pitch_deg, 90);
}

scripts::Flight lowered_flight() {
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1\nat 0 pose lon=0 lat=0 alt=200000 pitch=-30\nat 10 pose lon=5 lat=0 alt=200000 pitch=-30\n",
      "test");
  EXPECT_TRUE(parsed.flight.has_value());
  return *parsed.flight;
}

TEST(SessionLook, TheMouseTurnsAboutTheVerticalInAFlight) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().load(lowered_flight()), "");
  ASSERT_EQ(session.follow(true), "");
  session.press(MouseUse::kHold, {640, 360});
  for (int n = 1; n <= 20; ++n) {
    session.drag({640 - 20.0 * n, 360});
    const mars::CameraPose camera = session.view().camera;
    const mars::Pose seen = mars::to_pose(camera, session.ground().radius_m);
    EXPECT_NEAR(seen.roll_deg, 0, 1e-6) << "the horizon is level";
    EXPECT_NEAR(seen.pitch_deg, -30, 1e-6);
  }
  EXPECT_GT(session.look().yaw_deg, 15);
  // The flight plays on below the look.
  session.release(1.0);
  EXPECT_FALSE(session.is_moving());
  const double lon_deg = session.pose().lon_deg;
  session.advance(0.5, {});
  EXPECT_GT(session.pose().lon_deg, lon_deg);
  EXPECT_GT(session.look().yaw_deg, 15);
}

TEST(SessionLook, AHeadTrackerKeepsThePlatformsAxis) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().load(lowered_flight()), "");
  ASSERT_EQ(session.follow(false), "");
  session.advance(0.01, {}, {50, 0, 0});
  EXPECT_NEAR(session.look().yaw_deg, 50, 1e-9);
  EXPECT_EQ(session.look().roll_deg, 0);
  // A drag adds to it, and the sum is what is shown.
  session.press(MouseUse::kHold, {640, 360});
  session.drag({600, 360});
  session.advance(0.01, {}, {50, 0, 0});
  EXPECT_GT(session.look().yaw_deg, 50);
}

}  // namespace
}  // namespace vpe::explore
