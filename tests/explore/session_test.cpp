// Tests of a session without a window.
#include "vpe/explore/session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "scripts/flight.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/explore/draw_choice.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {
namespace {

std::shared_ptr<const paging::Surface> surface() {
  static const test_support::TempDir folder;
  static const auto planet = test_support::build_fake(
      folder / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 200'000);
  static const auto made = std::make_shared<const paging::Surface>(planet, std::size_t{32} << 20);
  return made;
}

Session session_at(const mars::Pose& pose) {
  SessionOptions options;
  options.start = pose;
  Session session(surface(), options);
  session.resize(1280, 720);
  return session;
}

// Advances until nothing moves without input.
void finish(Session& session, const mars::HeadAngles& head = {}) {
  for (int n = 0; n < 1000 && (session.is_going() || session.is_moving()); ++n) session.advance(0.02, {}, head);
  EXPECT_FALSE(session.is_going() || session.is_moving());
}

glm::dvec3 seen_at(const Session& session, glm::dvec2 xy) {
  const core::View view = session.view();
  const glm::dvec3 ray = core::pixel_ray(view, xy.x, xy.y);
  const double range_m = session.ground().cast_m(view.camera.position_m, ray);
  EXPECT_TRUE(std::isfinite(range_m));
  return view.camera.position_m + ray * range_m;
}

glm::dvec2 place_of(const Session& session, const glm::dvec3& at_m) {
  const core::Projected at = core::project(session.view(), at_m);
  EXPECT_FALSE(at.behind);
  return at.xy;
}

const mars::Pose kOver{20, 10, 150'000, 40, -35, 3};
// Directions of a head: straight ahead as a check, and aside.
const std::vector<mars::HeadAngles> kHeads{{0, 0, 0}, {30, -20, 8}, {-25, 10, 0}};

TEST(Session, TheMouseHoldsTheGroundForAnyDirectionOfTheHead) {
  for (const mars::HeadAngles& head : kHeads) {
    Session session = session_at(kOver);
    session.advance(0, {}, head);
    const glm::dvec2 from{500, 420};
    const glm::dvec3 held = seen_at(session, from);
    session.press(MouseUse::kHold, from);
    session.drag({620, 470});
    session.release();
    EXPECT_LT(glm::length(place_of(session, held) - glm::dvec2(620, 470)), 0.5) << head.yaw_deg;
  }
}

TEST(Session, TheWheelZoomsToTheCursorForAnyDirectionOfTheHead) {
  for (const mars::HeadAngles& head : kHeads) {
    Session session = session_at(kOver);
    session.advance(0, {}, head);
    const glm::dvec2 xy{800, 450};
    const glm::dvec3 under = seen_at(session, xy);
    const double before_m = glm::length(session.view().camera.position_m - under);
    session.wheel(xy, 2);
    finish(session, head);
    EXPECT_LT(glm::length(place_of(session, under) - xy), 0.5) << head.yaw_deg;
    EXPECT_NEAR(glm::length(session.view().camera.position_m - under), before_m / (1.35 * 1.35),
                0.06 * before_m);
  }
}

TEST(Session, ADoubleClickCentresThePlaceForAnyDirectionOfTheHead) {
  for (const mars::HeadAngles& head : kHeads) {
    Session session = session_at(kOver);
    session.advance(0, {}, head);
    const glm::dvec3 wanted = seen_at(session, {900, 500});
    session.fly_towards({900, 500});
    for (int n = 0; n < 1000 && session.is_going(); ++n) session.advance(0.1, {}, head);
    EXPECT_FALSE(session.is_going());
    EXPECT_LT(glm::length(place_of(session, wanted) - glm::dvec2(640, 360)), 1) << head.yaw_deg;
  }
}

TEST(Session, AnInvertedWheelZoomsOut) {
  SessionOptions options;
  options.start = kOver;
  options.mouse.invert_wheel = true;
  Session session(surface(), options);
  const double before_m = session.height_m();
  session.wheel({640, 360}, 1);
  finish(session);
  EXPECT_GT(session.height_m(), before_m);
}

TEST(Session, AFasterMouseTiltsFurther) {
  SessionOptions options;
  options.start = kOver;
  double rotated_deg[2];
  for (const double speed : {1.0, 2.0}) {
    options.mouse.speed = speed;
    Session session(surface(), options);
    session.press(MouseUse::kTilt, {640, 360});
    session.drag({640, 350});
    rotated_deg[speed == 2.0] = session.pose().pitch_deg - kOver.pitch_deg;
  }
  EXPECT_NEAR(rotated_deg[1], 2 * rotated_deg[0], 0.05 * std::abs(rotated_deg[0]));
  EXPECT_GT(std::abs(rotated_deg[0]), 1);
}

scripts::Flight flight(const std::string& more) {
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1\n" + more +
          "at 0 pose lon=0 lat=0 alt=200000 pitch=-30\nat 10 pose lon=5 lat=0 alt=200000 pitch=-30\n",
      "test");
  EXPECT_TRUE(parsed.flight.has_value());
  return *parsed.flight;
}

// A tracker's angles are added to a flight's look: a log cannot hold a look beyond straight up.
TEST(Session, PitchNeverExceedsStraightUp) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().load(flight("at 0 look yaw=170 pitch=60\n")), "");
  ASSERT_EQ(session.follow(false), "");
  session.advance(0.01, {}, {30, 45, 0});
  EXPECT_EQ(session.look().pitch_deg, 90);
  EXPECT_NEAR(session.look().yaw_deg, -160, 1e-9);
}

TEST(Session, SettingsByHandInAFlightHoldWhenTheFlightIsEdited) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().load(flight("at 0 set exaggeration=2\n")), "");
  ASSERT_EQ(session.follow(true), "");
  EXPECT_EQ(session.settings().values().exaggeration, 2);
  ASSERT_EQ(session.set("exaggeration", "5"), "");
  session.advance(0.5, {});
  EXPECT_EQ(session.settings().values().exaggeration, 5);
  ASSERT_EQ(session.flights().append(kOver, 1000), "");
  session.advance(0.5, {});
  session.advance(0.5, {});
  EXPECT_EQ(session.settings().values().exaggeration, 5);
}

scripts::Flight zooming_flight() {
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1.1\nview fov=60\nat 0 pose lon=0 lat=0 alt=200000 pitch=-30\n"
      "at 2 view fov=20\nat 10 pose lon=5 lat=0 alt=200000 pitch=-30\n",
      "test");
  EXPECT_TRUE(parsed.flight.has_value());
  return *parsed.flight;
}

TEST(Session, AFlightHasItsFieldOfViewAndGivesItBack) {
  Session session = session_at(kOver);
  session.set_fov(47);
  ASSERT_EQ(session.flights().load(zooming_flight()), "");
  EXPECT_EQ(session.screen().fov_deg, 47);
  ASSERT_EQ(session.follow(true), "");
  EXPECT_EQ(session.view().fov_deg, 60);
  session.advance(3, {});
  EXPECT_EQ(session.view().fov_deg, 20);
  session.scrub(0);
  EXPECT_EQ(session.view().fov_deg, 60);
  session.leave_flight();
  EXPECT_EQ(session.view().fov_deg, 47);
  ASSERT_EQ(session.follow(false), "");
  EXPECT_EQ(session.view().fov_deg, 60);
  session.flights().clear();
  session.advance(0.1, {});
  EXPECT_EQ(session.view().fov_deg, 47);
}

TEST(Session, AFlightWithoutFieldsOfViewKeepsTheUsers) {
  Session session = session_at(kOver);
  session.set_fov(33);
  ASSERT_EQ(session.flights().load(flight("view fov=70\n")), "");
  ASSERT_EQ(session.follow(true), "");
  EXPECT_EQ(session.view().fov_deg, 33);
}

TEST(Session, AFieldOfViewByHandInAFlightHoldsUntilTheFlightIsLeft) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().load(zooming_flight()), "");
  ASSERT_EQ(session.follow(true), "");
  session.wheel({640, 360}, 1);
  const double by_hand_deg = session.view().fov_deg;
  EXPECT_LT(by_hand_deg, 50);
  session.advance(1, {});
  EXPECT_EQ(session.view().fov_deg, by_hand_deg);
  ASSERT_EQ(session.flights().append(kOver, 1000), "");  // an edit makes another player
  session.advance(1, {});
  EXPECT_EQ(session.view().fov_deg, by_hand_deg);
  session.leave_flight();
  EXPECT_EQ(session.view().fov_deg, by_hand_deg);
  ASSERT_EQ(session.follow(false), "");
  EXPECT_NE(session.view().fov_deg, by_hand_deg);  // the flight's again
}

scripts::Flight level_flight() {
  return *scripts::parse_flight(
              "flight 1\nat 0 pose lon=0 lat=0 alt=20000 yaw=90\nat 100 pose lon=2 lat=0 alt=20000 yaw=90\n",
              "")
              .flight;
}

TEST(Session, MovingByHandLeavesTheCourseOfAFlightThatPlays) {
  Session session = session_at({10, 0, 50000, 0, 0, 0});
  Session alone = session_at({10, 0, 50000, 0, 0, 0});
  for (Session* s : {&session, &alone}) {
    ASSERT_EQ(s->flights().load(level_flight()), "");
    ASSERT_EQ(s->follow(true), "");
  }
  Controls left;
  left.right = -1;
  left.up = 0.5;
  for (int n = 0; n < 50; ++n) {
    session.advance(0.02, left);
    alone.advance(0.02, {});
  }
  EXPECT_TRUE(session.follows_flight());
  EXPECT_TRUE(session.player()->is_playing());
  EXPECT_EQ(session.player()->time_s(), alone.player()->time_s());
  EXPECT_GT(session.pose().alt_m, alone.pose().alt_m + 1000);
  EXPECT_GT(session.pose().lat_deg, 0.05) << "north is to the left of a course to the east";
  EXPECT_NEAR(session.pose().lon_deg, alone.pose().lon_deg, 1e-6);
  // The offset stays, also when the flight is edited, paused and scrubbed.
  const double lat_deg = session.pose().lat_deg;
  for (int n = 0; n < 50; ++n) session.advance(0.02, {});
  EXPECT_NEAR(session.pose().lat_deg, lat_deg, 1e-9);
  ASSERT_EQ(session.flights().editor()->scale_times(2), "");
  ASSERT_EQ(session.follow(false), "");
  session.scrub(50);
  EXPECT_NEAR(session.pose().lat_deg, lat_deg, 1e-9);
  session.leave_flight();
  EXPECT_NEAR(session.pose().lat_deg, lat_deg, 1e-9);
  ASSERT_EQ(session.follow(false), "");
  EXPECT_EQ(session.pose().lat_deg, 0);
}

TEST(Session, AnOffsetOfThePlatformStaysAboveTheGround) {
  Session session = session_at({10, 0, 50000, 0, 0, 0});
  ASSERT_EQ(session.flights().load(level_flight()), "");
  ASSERT_EQ(session.follow(true), "");
  Controls down;
  down.up = -1;
  for (int n = 0; n < 1000; ++n) {
    session.advance(0.02, down);
    ASSERT_GE(session.height_m(), SteerLimits::kClearance_m - 1e-6) << n;
  }
  EXPECT_LT(session.height_m(), 200) << "the ground below may fall away meanwhile";
  Controls up;
  up.up = 1;
  session.advance(0.02, up);
  const double before_m = session.height_m();
  for (int n = 0; n < 25; ++n) session.advance(0.02, up);
  EXPECT_GT(session.height_m(), before_m + 0.5) << "a motion up takes effect at once";
}

TEST(Session, StandsOnGroundThatHasChanged) {
  const test_support::TempDir folder;
  const auto raised = std::make_shared<const paging::Surface>(
      test_support::build_fake(folder / "raised.vpe", test_support::FakeElevation([](const glm::dvec3& d) {
                                 return test_support::bumpy_height(d) + 9000;
                               }),
                               200'000),
      std::size_t{8} << 20);
  const glm::dvec3 up = mars::direction({10, 0});
  const double ground_m = surface()->at(up).height_m;
  Session session = session_at({10, 0, ground_m + 2000, 0, -90, 0});
  const std::uint64_t changes = session.changes();
  session.set_changed_surface(raised);
  EXPECT_EQ(session.shared_surface(), raised);
  EXPECT_EQ(session.changes(), changes) << "the image has shown it already";
  EXPECT_NEAR(session.ground().height_m(up), ground_m + 9000, 60);
  EXPECT_GT(session.pose().alt_m, session.ground().height_m(up)) << "the camera is above the ground";
  session.set_changed_surface(surface());
  EXPECT_EQ(session.ground().height_m(up), ground_m);
  // A flight keeps the terrain that its poses count from.
  const auto flight =
      scripts::parse_flight("flight 1\nat 0 pose lon=10 lat=0 height=20000 pitch=-90\nat 9 end\n", "F");
  ASSERT_TRUE(flight.flight);
  ASSERT_EQ(session.flights().load(*flight.flight), "");
  session.scrub(1);
  const double alt_m = session.pose().alt_m;
  session.set_changed_surface(raised);
  session.scrub(2);
  EXPECT_EQ(session.pose().alt_m, alt_m);
  EXPECT_NEAR(session.height_m(), 11000, 60);
}

TEST(DrawChooser, AFlightDecidesWhatTheUserDoesNotChange) {
  const scripts::ParsedFlight parsed = scripts::parse_flight(
      "flight 1.1\nat 0 pose lon=0 lat=0 alt=1000\nat 1 view backend=ray\nat 2 view eyes=ou base=7 convergence=50\n"
      "at 3 view backend=polygon eyes=off\nat 9 end\n",
      "test");
  FlightPlayer player(scripts::Path(*parsed.flight, mars::kMarsRadius_m, {}), mars::kMarsRadius_m);
  DrawChooser chooser;
  DrawChoice own{core::DrawnBy::kAuto, core::StereoLayout::kAnaglyph, 2, 0};
  EXPECT_EQ(chooser.update(own, nullptr), own);
  EXPECT_EQ(chooser.update(own, &player), own);  // the flight has said nothing yet
  player.scrub(1);
  EXPECT_EQ(chooser.update(own, &player),
            (DrawChoice{core::DrawnBy::kRay, core::StereoLayout::kAnaglyph, 2, 0}));
  player.scrub(2);
  EXPECT_EQ(chooser.update(own, &player),
            (DrawChoice{core::DrawnBy::kRay, core::StereoLayout::kOverUnder, 7, 50}));
  EXPECT_EQ(chooser.choice().stereo, core::StereoLayout::kOverUnder);
  own.stereo = core::StereoLayout::kSideBySide;
  EXPECT_EQ(chooser.update(own, &player),
            (DrawChoice{core::DrawnBy::kRay, core::StereoLayout::kSideBySide, 2, 0}));
  player.scrub(3);
  EXPECT_EQ(chooser.update(own, &player),
            (DrawChoice{core::DrawnBy::kPolygon, core::StereoLayout::kSideBySide, 2, 0}));
  own.drawn_by = core::DrawnBy::kRay;
  EXPECT_EQ(chooser.update(own, &player), own);
  EXPECT_EQ(chooser.update(own, nullptr), own);
  player.release_view();
  EXPECT_EQ(chooser.update(own, &player), (DrawChoice{core::DrawnBy::kPolygon, {}, 7, 50}));
}

TEST(Session, TheFirstWaypointIsNotSavedYet) {
  Session session = session_at(kOver);
  ASSERT_EQ(session.flights().append(kOver, 1000), "");
  EXPECT_TRUE(session.flights().editor()->is_changed());
  session.flights().editor()->mark_saved();
  EXPECT_FALSE(session.flights().editor()->is_changed());
}

}  // namespace
}  // namespace vpe::explore
