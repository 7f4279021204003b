#include "vpe/explore/flight_player.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace vpe::explore {
namespace {

constexpr const char* kFlight =
    "flight 1\n"
    "at 0 pose lon=-74 lat=-13.5 alt=12000 yaw=90 pitch=-15\n"
    "at 2 look yaw=0\n"
    "at 3 look yaw=40 pitch=5\n"
    "at 3 set mode=wireframe exaggeration=2\n"
    "at 4 pose lon=-70 lat=-12 alt=9000 yaw=100 pitch=-10 roll=-20\n"
    "at 5 set exaggeration=3\n"
    "at 6 interest lon=0 lat=0 radius=1000 levels=2\n"
    "at 8 pose lon=-68 lat=-11 alt=3000 yaw=80 pitch=-10\n"
    "at 10 end\n";

scripts::Path path_of(const char* text) {
  return {*scripts::parse_flight(text, "").flight, mars::kMarsRadius_m, {}};
}

FlightPlayer player_of(const char* text = kFlight) { return {path_of(text), mars::kMarsRadius_m}; }

void expect_state(const FlightPlayer& player, double time_s) {
  const scripts::FlightState is = player.state();
  const scripts::FlightState wanted = path_of(kFlight).at(time_s);
  EXPECT_EQ(is.camera.position_m, wanted.camera.position_m) << time_s;
  EXPECT_EQ(is.camera.axes.forward, wanted.camera.axes.forward) << time_s;
  EXPECT_EQ(is.head.yaw_deg, wanted.head.yaw_deg) << time_s;
}

std::string exaggeration_of(const FlightPlayer& player, const core::Settings& base = {}) {
  return *player.settings(base).get("exaggeration");
}

TEST(FlightPlayer, EndsExactlyAtTheEndAndBeginsAgain) {
  FlightPlayer player = player_of();
  EXPECT_FALSE(player.is_playing());
  player.advance(3);
  EXPECT_EQ(player.time_s(), 0);  // paused
  player.play();
  for (int n = 0; n < 99; ++n) player.advance(0.1);
  EXPECT_TRUE(player.is_playing());
  EXPECT_NEAR(player.time_s(), 9.9, 1e-12);
  expect_state(player, player.time_s());
  player.advance(0.3);
  EXPECT_EQ(player.time_s(), 10);
  EXPECT_TRUE(player.at_end());
  EXPECT_FALSE(player.is_playing());
  expect_state(player, 10);
  player.play();
  EXPECT_EQ(player.time_s(), 0);
  player.advance(1.5);
  player.pause();
  player.advance(1.5);
  EXPECT_EQ(player.time_s(), 1.5);
  player.play();
  player.advance(0.25);
  EXPECT_EQ(player.time_s(), 1.75);
}

TEST(FlightPlayer, LoopsExactlyForFramesOfAnyLength) {
  FlightPlayer player = player_of();
  player.set_loop(true);
  player.play();
  player.advance(9.75);
  player.advance(0.5);
  EXPECT_EQ(player.time_s(), 0.25);
  player.advance(40);  // four rounds
  EXPECT_EQ(player.time_s(), 0.25);
  player.advance(9.75);  // the end is the start
  EXPECT_EQ(player.time_s(), 0);
  EXPECT_TRUE(player.is_playing());
  player.set_speed(-2);
  player.advance(1);
  EXPECT_EQ(player.time_s(), 8);
  player.advance(10);
  EXPECT_EQ(player.time_s(), 8);
  EXPECT_TRUE(player.is_playing());
}

TEST(FlightPlayer, PlaysAtAnySpeedAlsoBackwards) {
  FlightPlayer player = player_of();
  player.set_speed(4);
  player.play();
  player.advance(1.25);
  EXPECT_EQ(player.time_s(), 5);
  player.set_speed(-0.5);
  player.advance(2);
  EXPECT_EQ(player.time_s(), 4);
  expect_state(player, 4);
  player.advance(100);
  EXPECT_EQ(player.time_s(), 0);
  EXPECT_FALSE(player.is_playing());
  player.play();  // backwards from the end
  EXPECT_EQ(player.time_s(), 10);
  player.set_speed(0);
  player.set_speed(std::nan(""));
  EXPECT_EQ(player.speed(), -0.5);
  player.set_speed(1e9);
  EXPECT_EQ(player.speed(), FlightPlayerLimits::kFastest);
  player.set_speed(-1e-9);
  EXPECT_EQ(player.speed(), -FlightPlayerLimits::kSlowest);
  player.advance(-5);
  player.advance(std::nan(""));
  EXPECT_EQ(player.time_s(), 10);
}

TEST(FlightPlayer, ScrubbedBackwardsSettingsAreThoseOfThatTime) {
  FlightPlayer player = player_of();
  core::Settings base;
  ASSERT_EQ(base.set("exaggeration", "1.5"), "");
  const auto at = [&](double time_s) {
    player.scrub(time_s);
    return exaggeration_of(player, base);
  };
  EXPECT_EQ(at(0), "1.5");
  EXPECT_EQ(at(3), "2");
  EXPECT_EQ(at(9), "3");
  EXPECT_EQ(player.interests().size(), 1U);
  EXPECT_EQ(at(4.9), "2");
  EXPECT_TRUE(player.interests().empty());
  EXPECT_EQ(at(2.9), "1.5");
  EXPECT_EQ(*player.settings(base).get("mode"), *base.get("mode"));
  player.scrub(-5);
  EXPECT_EQ(player.time_s(), 0);
  player.scrub(1e9);
  EXPECT_EQ(player.time_s(), 10);
  player.scrub(std::nan(""));
  EXPECT_EQ(player.time_s(), 0);
}

TEST(FlightPlayer, LookingAroundLeavesTheFlightAlone) {
  FlightPlayer alone = player_of();
  FlightPlayer looking = player_of();
  alone.play();
  looking.play();
  for (int n = 0; n < 80; ++n) {
    alone.advance(0.1);
    looking.advance(0.1);
    looking.add_look_offset(7, n % 2 == 0 ? 3 : -1, 0.5);
    const scripts::FlightState a = alone.state();
    const scripts::FlightState b = looking.state();
    EXPECT_EQ(alone.time_s(), looking.time_s());
    EXPECT_EQ(a.pose.lon_deg, b.pose.lon_deg);
    EXPECT_EQ(a.pose.yaw_deg, b.pose.yaw_deg);
    EXPECT_EQ(a.camera.position_m, b.camera.position_m);
    EXPECT_NE(a.camera.axes.forward, b.camera.axes.forward);
  }
  looking.reset_look_offset();
  expect_state(looking, looking.time_s());
}

TEST(FlightPlayer, TheUsersLookIsAddedToTheFlights) {
  FlightPlayer player = player_of();
  player.scrub(3);
  player.set_look_offset({20, 10, -5});
  const scripts::FlightState state = player.state();
  EXPECT_EQ(state.head.yaw_deg, 60);
  EXPECT_EQ(state.head.pitch_deg, 15);
  EXPECT_EQ(state.head.roll_deg, -5);
  const mars::CameraPose camera = mars::to_camera(state.pose, {60, 15, -5}, mars::kMarsRadius_m);
  EXPECT_EQ(state.camera.axes.forward, camera.axes.forward);
  EXPECT_EQ(state.camera.axes.up, camera.axes.up);
  player.add_look_offset(400, 500);
  EXPECT_EQ(player.state().head.pitch_deg, 90);
  EXPECT_EQ(player.state().head.yaw_deg, 100);
  player.add_look_offset(0, -1);  // takes effect at once
  EXPECT_EQ(player.state().head.pitch_deg, 89);
  player.set_look_offset({std::nan(""), std::numeric_limits<double>::infinity(), 0});
  expect_state(player, 3);
}

// The oracle is the law of cosines: the offset place is at the distance of the offset, in its direction.
TEST(FlightPlayer, ThePlatformsOffsetKeepsItsSideOfTheCourse) {
  FlightPlayer player = player_of();
  player.set_platform_offset({3000, 400, 4000});
  for (const double time_s : {0.0, 1.7, 4.0, 6.3, 9.0}) {
    player.scrub(time_s);
    const scripts::FlightState own = path_of(kFlight).at(time_s);
    const scripts::FlightState state = player.state();
    EXPECT_NEAR(state.pose.alt_m, own.pose.alt_m + 400, 1e-9);
    const glm::dvec3 from = mars::direction({own.pose.lon_deg, own.pose.lat_deg});
    const glm::dvec3 to = mars::direction({state.pose.lon_deg, state.pose.lat_deg});
    const double radius_m = mars::kMarsRadius_m + own.pose.alt_m;
    EXPECT_NEAR(mars::angle_between_rad(from, to) * radius_m, 5000, 1e-5);
    const mars::LocalFrame frame = mars::local_frame({own.pose.lon_deg, own.pose.lat_deg});
    const double bearing_deg =
        std::atan2(glm::dot(to, frame.east), glm::dot(to, frame.north)) / mars::kRadiansPerDegree;
    EXPECT_NEAR(std::remainder(bearing_deg - own.pose.yaw_deg - 36.86989764584402, 360.0), 0, 1e-6);
    EXPECT_EQ(state.pose.pitch_deg, own.pose.pitch_deg);
    EXPECT_EQ(state.pose.roll_deg, own.pose.roll_deg);
    EXPECT_EQ(state.camera.position_m, mars::to_camera(state.pose, state.head, mars::kMarsRadius_m).position_m);
    EXPECT_EQ(player.time_s(), time_s);
  }
  player.set_platform_offset({});
  expect_state(player, 9);
}

TEST(FlightPlayer, BadOffsetsOfThePlatformDoNoHarm) {
  FlightPlayer player = player_of();
  player.set_platform_offset({std::nan(""), std::numeric_limits<double>::infinity(), 0});
  expect_state(player, 0);
  player.set_platform_offset({1e300, -1e300, -1e300});
  EXPECT_EQ(player.platform_offset(), (PlatformOffset{1e7, -1e7, -1e7}));
  EXPECT_TRUE(std::isfinite(glm::length(player.state().camera.position_m)));
  EXPECT_GT(glm::length(player.state().camera.position_m), 1e6);
}

TEST(FlightPlayer, TheUsersSettingsHoldWhileTheFlightPlays) {
  FlightPlayer player = player_of();
  EXPECT_EQ(player.keep_setting("exaggeration", "7"), "");
  EXPECT_NE(player.keep_setting("exaggeration", "much"), "");
  EXPECT_NE(player.keep_setting("nonsense", "1"), "");
  for (const double t : {0.0, 3.0, 5.0}) {
    player.scrub(t);
    EXPECT_EQ(exaggeration_of(player), "7");
  }
  EXPECT_EQ(*player.settings({}).get("mode"), "wireframe");
  player.release_setting("exaggeration");
  EXPECT_EQ(exaggeration_of(player), "3");
  ASSERT_EQ(player.keep_setting("mode", "unlit"), "");
  player.release_settings();
  EXPECT_EQ(*player.settings({}).get("mode"), "wireframe");
}

TEST(FlightPlayer, AFlightWithoutDurationStandsAtItsPose) {
  FlightPlayer player = player_of("flight 1\nat 0 pose lon=1 lat=2 alt=3\n");
  for (const bool loop : {false, true}) {
    player.set_loop(loop);
    player.play();
    player.advance(1);
    EXPECT_EQ(player.time_s(), 0);
    EXPECT_FALSE(player.is_playing());
  }
  EXPECT_EQ(player.state().pose.lon_deg, 1);
}

}  // namespace
}  // namespace vpe::explore
