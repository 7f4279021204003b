// Flights whose times, distances and speeds differ by many orders of magnitude, and flights of more than a day.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scripts/path.h"
#include "tests/support/support.h"
#include "tests/support/worst.h"
#include "vpe/explore/flight_player.h"
#include "vpe/explore/steer.h"

namespace {

using scripts::Flight;
using scripts::FlightState;
using scripts::Path;
using scripts::Waypoint;
using test_support::Random;
using test_support::record_worst;

constexpr double kRadius_m = mars::kMarsRadius_m;

Waypoint waypoint(double time_s, mars::LonLat place, double alt_m, double yaw_deg, double pitch_deg = 0,
                  double roll_deg = 0) {
  return {time_s, place.lon_deg, place.lat_deg, alt_m, false, yaw_deg, pitch_deg, roll_deg};
}

glm::dvec3 up_of(const FlightState& state) { return glm::normalize(state.camera.position_m); }

// Returns a flight whose segments take a thousandth of a second or a thousand seconds, over arcs of 0 to 3
// radians.
Flight stiff_flight(Random& random) {
  Flight flight;
  double t = 0;
  mars::LonLat at = mars::lon_lat(random.direction());
  for (int n = 0; n < 8; ++n) {
    const double alt_m = random.log_uniform(0.1, 1e8);
    const glm::dvec3 turn_deg{random.uniform(-180, 180), random.uniform(-90, 90), random.uniform(-180, 180)};
    flight.waypoints.push_back(waypoint(t, at, alt_m, turn_deg.x, turn_deg.y, turn_deg.z));
    flight.heads.push_back({t, random.uniform(-180, 180), random.uniform(-90, 90), random.uniform(-180, 180)});
    t += random.integer(0, 1) == 0 ? 1e-3 : 1e3;
    const int kind = random.integer(0, 3);
    const double arc_rad = kind == 0 ? 0.0 : kind == 1 ? random.uniform(1, 3) : random.log_uniform(1e-7, 1);
    at = mars::destination(at, random.uniform(0, 360), arc_rad);
  }
  return flight;
}

TEST(StiffFlight, NeverOvershoots) {
  Random random(341);
  double swing = 0;
  double speed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Flight flight = stiff_flight(random);
    const Path path(flight, kRadius_m, {});
    for (std::size_t i = 0; i + 1 < flight.waypoints.size(); ++i) {
      const Waypoint& a = flight.waypoints[i];
      const Waypoint& b = flight.waypoints[i + 1];
      const glm::dvec3 from = mars::direction({a.lon_deg, a.lat_deg});
      const double arc_rad = mars::angle_between_rad(from, mars::direction({b.lon_deg, b.lat_deg}));
      const auto [low, high] = std::minmax(a.up_m, b.up_m);
      glm::dvec3 before = from;
      constexpr int kSteps = 200;
      for (int k = 1; k <= kSteps; ++k) {
        const FlightState state =
            path.at(k == kSteps ? b.time_s : a.time_s + (b.time_s - a.time_s) * k / kSteps);
        for (const glm::dvec3& v : {state.camera.position_m, state.camera.axes.right, state.camera.axes.up,
                                    state.camera.axes.forward})
          ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
        ASSERT_TRUE(state.pose.alt_m >= low && state.pose.alt_m <= high);
        const glm::dvec3 up = up_of(state);
        if (arc_rad > 1e-9) {
          swing = std::max(swing, (mars::angle_between_rad(from, up) - 1e-15) / arc_rad);
          speed = std::max(speed, (mars::angle_between_rad(before, up) - 1e-15) * kSteps / arc_rad);
        } else {
          ASSERT_LE(mars::angle_between_rad(from, up), 2e-15) << "moves where it rests";
        }
        before = up;
      }
    }
  }
  // scripts/spherical_spline.h
  record_worst("stiff flights: farthest from a segment's start", swing, 1.22, "of the segment");
  record_worst("stiff flights: fastest", speed, 2.5, "of the segment's mean speed");
}

// 10^-3 s beside 10^3 s, the one a million times as fast as the other.
TEST(StiffFlight, VelocityIsContinuousAcrossSpeedsAMillionApart) {
  Random random(342);
  double jump = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Flight flight;
    const mars::LonLat start = mars::lon_lat(random.direction());
    const double bearing_deg = random.uniform(0, 360);
    const mars::LonLat next = mars::destination(start, bearing_deg, random.log_uniform(1e-4, 1));
    // The same distance in a millionth of the time, or a millionth of the distance in the same time.
    const bool short_time = trial % 2 == 0;
    const double arc_rad = mars::distance_rad(start, next) * (short_time ? 1.0 : 1e-6);
    const mars::LonLat last = mars::destination(next, random.uniform(0, 360), std::max(arc_rad, 1e-9));
    flight.waypoints = {waypoint(0, start, 1000, 10), waypoint(1000, next, 2000, 50),
                        waypoint(short_time ? 1000.001 : 2000, last, 1500, -170)};
    const Path path(flight, kRadius_m, {});
    const auto velocity = [&](double side, double span_s) {
      const double h = side * 1e-3 * span_s;
      return (up_of(path.at(1000)) * -3.0 + up_of(path.at(1000 + h)) * 4.0 - up_of(path.at(1000 + 2 * h))) /
             (2 * h);
    };
    const double before_s = 1000;
    const double after_s = flight.waypoints[2].time_s - 1000;
    const double speed =
        std::max(mars::distance_rad(start, next) / before_s, mars::distance_rad(next, last) / after_s);
    jump = std::max(jump, glm::length(velocity(-1, before_s) - velocity(1, after_s)) / speed);
  }
  record_worst("stiff flights: velocity at a waypoint, before less after", jump, 3e-3,
               "of the faster segment's speed");
}

TEST(StiffFlight, CoincidentPosesRestAndOppositeOnesAreRefused) {
  const auto flown = [](double away_rad) {
    Flight flight;
    flight.waypoints = {waypoint(0, {20, 30}, 1000, 0),
                        waypoint(10, mars::destination({20, 30}, 77, away_rad), 1000, 0)};
    return Path(flight, kRadius_m, {});
  };
  EXPECT_THROW(flown(mars::kPi), std::runtime_error);
  EXPECT_THROW(flown(mars::kPi - 5e-7), std::runtime_error);
  // Just not opposite: a half circle, evenly.
  const double away_rad = mars::kPi - 2e-6;
  const Path nearly = flown(away_rad);
  double uneven = 0;
  for (int k = 0; k < 1000; ++k) {
    const double step = mars::angle_between_rad(up_of(nearly.at(k * 0.01)), up_of(nearly.at((k + 1) * 0.01)));
    uneven = std::max(uneven, std::abs(step * 1000 / away_rad - 1));
  }
  record_worst("flights: nearly opposite poses, evenness of the speed", uneven, 1e-9, "of the speed");

  // The same pose many times, at times a thousandth and a thousand seconds apart.
  Flight still;
  double t = 0;
  for (int n = 0; n < 20; ++n) {
    still.waypoints.push_back(waypoint(t, {180, -90}, 12.5, 33, -7, 179));
    t += n % 2 == 0 ? 1e-3 : 1e3;
  }
  const Path rest(still, kRadius_m, {});
  const FlightState held = rest.at(0);
  for (int k = 0; k <= 5000; ++k) {
    const FlightState state = rest.at(rest.duration_s() * k / 5000);
    ASSERT_EQ(state.camera.position_m, held.camera.position_m);
    ASSERT_EQ(state.camera.axes.forward, held.camera.axes.forward);
  }
}

// Twenty degrees a second, repeatedly through 180 degrees, of platform and head.
TEST(StiffFlight, YawPassesThrough180DegreesEvenly) {
  Flight flight;
  for (int k = 0; k <= 90; ++k) {
    const double yaw_deg = mars::normalize_lon_deg(20.0 * k);
    flight.waypoints.push_back(waypoint(k, {179.9, 12}, 500, yaw_deg));
    flight.heads.push_back({static_cast<double>(k), mars::normalize_lon_deg(-20.0 * k), 0, 0});
  }
  const Path path(flight, kRadius_m, {});
  double platform = 0;
  double head = 0;
  for (int k = 0; k <= 90 * 64; ++k) {
    const double t = k / 64.0;
    const FlightState state = path.at(t);
    platform = std::max(platform, std::abs(std::remainder(state.pose.yaw_deg - 20 * t, 360)));
    head = std::max(head, std::abs(std::remainder(state.head.yaw_deg + 20 * t, 360)));
  }
  record_worst("flights: yaw through 180 degrees, platform", platform, 1e-9, "degrees off an even rotation");
  record_worst("flights: yaw through 180 degrees, head", head, 1e-9, "degrees off an even rotation");
}

Flight long_flight(Random& random) {
  Flight flight;
  mars::LonLat at{0, 10};
  for (int n = 0; n <= 1000; ++n) {
    const double alt_m = random.uniform(1e3, 2e5);
    flight.waypoints.push_back(waypoint(100.0 * n, at, alt_m, random.uniform(-180, 180), -20));
    at = mars::destination(at, random.uniform(0, 360), 0.1);
  }
  return flight;
}

// A state depends on its time alone: 10^5 seconds in a row, backwards, and here and there.
TEST(LongReplay, StatesDoNotDependOnWhatWasPlayed) {
  Random random(344);
  const Path path(long_flight(random), kRadius_m, {});
  const scripts::FrameRate rate{30000, 1001};
  const std::int64_t frames = scripts::frame_count(rate, path.duration_s());
  const auto at = [&](std::int64_t k) { return path.at(scripts::frame_time(rate, k)); };
  std::vector<glm::dvec3> cameras;
  std::vector<std::int64_t> some;
  for (std::int64_t k = 0; k < frames; k += 97) some.push_back(k);
  for (const std::int64_t k : some) cameras.push_back(at(k).camera.position_m);
  for (std::size_t n = some.size(); n-- > 0;) ASSERT_EQ(at(some[n]).camera.position_m, cameras[n]);
  for (int n = 0; n < 2000; ++n) {
    const auto pick = static_cast<std::size_t>(random.integer(0, static_cast<int>(some.size()) - 1));
    ASSERT_EQ(at(some[pick]).camera.position_m, cameras[pick]);
  }
  double drift_s = 0;
  for (std::int64_t k = 0; k <= frames; k += 11) {
    const long double exact = static_cast<long double>(k) * rate.denominator / rate.numerator;
    drift_s = std::max(drift_s, static_cast<double>(std::abs(scripts::frame_time(rate, k) - exact)));
  }
  record_worst("films: time of a frame within 10^5 s", drift_s, 0.5 * std::exp2(-36), "s");
}

// A player adds frame times up: 6 million of them in 10^5 s.
TEST(LongReplay, ThePlayerKeepsTime) {
  Random random(345);
  vpe::explore::FlightPlayer player(Path(long_flight(random), kRadius_m, {}), kRadius_m);
  Flight loop;
  loop.waypoints = {waypoint(0, {0, 0}, 100, 0), waypoint(7, {1, 0}, 100, 0)};
  vpe::explore::FlightPlayer looped(Path(loop, kRadius_m, {}), kRadius_m);
  looped.set_loop(true);
  player.play();
  looped.play();
  double drift_s = 0;
  double loop_drift_s = 0;
  for (std::int64_t k = 1; k < 6'000'000; ++k) {
    player.advance(1.0 / 60);
    looped.advance(1.0 / 60);
    if (k % 1000 != 0) continue;
    const double exact_s = static_cast<double>(k) / 60;
    drift_s = std::max(drift_s, std::abs(player.time_s() - exact_s));
    loop_drift_s = std::max(loop_drift_s, std::abs(std::remainder(looped.time_s() - exact_s, 7.0)));
  }
  record_worst("player: 10^5 s in steps of 1/60 s", drift_s, 1e-4, "s");
  record_worst("player: 10^5 s of a loop of 7 s", loop_drift_s, 1e-4, "s");
}

// 10^5 s along a great circle over the poles, in steps of a second: where the camera ends is where it should.
TEST(LongReplay, SteeringStraightAheadStaysOnItsGreatCircle) {
  const vpe::explore::TerrainQuery ball = vpe::explore::ball(kRadius_m);
  constexpr double kStep_m = 800;
  for (const double heading_deg : {0.0, 37.0, 90.0}) {
    const mars::LonLat start{170, 60};
    mars::Pose pose{start.lon_deg, start.lat_deg, 50000, heading_deg, 0, 0};
    const mars::LocalFrame frame = mars::local_frame(start);
    const mars::SinCos heading = mars::sin_cos_deg(heading_deg);
    const glm::dvec3 ahead = frame.north * heading.cos + frame.east * heading.sin;
    double across = 0;
    double along = 0;
    for (int k = 1; k <= 100000; ++k) {
      pose = vpe::explore::moved(pose, 0, 0, kStep_m, ball);
      if (k % 100 != 0) continue;
      const glm::dvec3 up = mars::direction({pose.lon_deg, pose.lat_deg});
      const double angle = k * kStep_m / (kRadius_m + 50000);
      across = std::max(across, std::abs(glm::dot(up, glm::cross(frame.up, ahead))));
      along =
          std::max(along, std::abs(std::remainder(
                              std::atan2(glm::dot(up, ahead), glm::dot(up, frame.up)) - angle, 2 * mars::kPi)));
    }
    record_worst("steering: 10^5 steps straight ahead, across", across, 1e-9, "rad");
    record_worst("steering: 10^5 steps straight ahead, along", along, 1e-9, "rad");
    EXPECT_EQ(pose.alt_m, 50000);
  }
}

}  // namespace
