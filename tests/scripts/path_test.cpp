#include "scripts/path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "tests/support/support.h"

namespace scripts {
namespace {

using test_support::Random;

constexpr double kRadius_m = mars::kMarsRadius_m;

Flight flight_of(const std::string& lines) {
  const ParsedFlight parsed = parse_flight("flight 1\n" + lines, "test");
  if (!parsed.flight) throw std::logic_error(to_string(parsed.errors.at(0)));
  return *parsed.flight;
}

Path path_of(const std::string& lines) { return {flight_of(lines), kRadius_m, {}}; }

glm::dvec3 up_of(const FlightState& state) { return glm::normalize(state.camera.position_m); }

double pitch_deg(const FlightState& state) {
  return std::asin(std::clamp(glm::dot(state.camera.axes.forward, up_of(state)), -1.0, 1.0)) /
         mars::kRadiansPerDegree;
}

bool equal(const mars::Axes& a, const mars::Axes& b) {
  return a.right == b.right && a.up == b.up && a.forward == b.forward;
}

double turned_rad(const mars::Axes& a, const mars::Axes& b) {
  const double trace = glm::dot(a.right, b.right) + glm::dot(a.up, b.up) + glm::dot(a.forward, b.forward);
  return std::acos(std::clamp((trace - 1.0) / 2.0, -1.0, 1.0));
}

Waypoint waypoint(double time_s, mars::LonLat place, double alt_m, double yaw_deg, double pitch) {
  return {time_s, place.lon_deg, place.lat_deg, alt_m, false, yaw_deg, pitch, 0};
}

// Returns random waypoints, with holds, anywhere on the planet.
Flight random_flight(Random& random) {
  Flight flight;
  double t = random.integer(0, 2) == 0 ? random.uniform(0.1, 3) : 0.0;
  glm::dvec3 place = random.direction();
  const int count = random.integer(2, 8);
  for (int i = 0; i < count; ++i) {
    const mars::LonLat at = mars::lon_lat(place);
    Waypoint w{t,
               at.lon_deg,
               at.lat_deg,
               random.log_uniform(1, 1e7),
               false,
               random.uniform(-180, 180),
               random.uniform(-89, 89),
               random.uniform(-180, 180)};
    if (i > 0 && random.integer(0, 3) == 0) {
      w = flight.waypoints.back();
      w.time_s = t;
    }
    flight.waypoints.push_back(w);
    flight.heads.push_back({t, random.uniform(-180, 180), random.uniform(-90, 90), random.uniform(-180, 180)});
    t += random.log_uniform(0.3, 30);
    const glm::dvec3 away = random.direction();
    place = glm::normalize(place + away * random.log_uniform(1e-5, 0.95));
  }
  if (random.integer(0, 1) == 0) flight.end_s = t;
  return flight;
}

struct Velocities {
  glm::dvec3 before;
  glm::dvec3 after;
};

// Computes a velocity by one-sided second-order differences.
template <class Function>
Velocities velocities(const Function& f, double t, double h) {
  return {(f(t) * 3.0 - f(t - h) * 4.0 + f(t - 2 * h)) / (2 * h),
          (f(t) * -3.0 + f(t + h) * 4.0 - f(t + 2 * h)) / (2 * h)};
}

TEST(PathProperty, VelocityIsContinuousAtWaypoints) {
  int checked = 0;
  Random random(8);
  for (int n = 0; n < 400; ++n) {
    const Flight flight = random_flight(random);
    const Path path(flight, kRadius_m, {});
    std::vector<double> times_s;
    for (const Waypoint& w : flight.waypoints) times_s.push_back(w.time_s);
    if (times_s.front() > 0) times_s.insert(times_s.begin(), 0.0);
    if (flight.end_s) times_s.push_back(*flight.end_s);
    for (std::size_t i = 1; i + 1 < times_s.size(); ++i) {
      const double t = times_s[i];
      const double before_s = t - times_s[i - 1];
      const double after_s = times_s[i + 1] - t;
      const double h = 2e-4 * std::min(before_s, after_s);
      const auto check = [&](const auto& f, double rounding) {
        const glm::dvec3 p = f(t);
        const double scale =
            glm::length(p - f(times_s[i - 1])) / before_s + glm::length(f(times_s[i + 1]) - p) / after_s;
        const Velocities v = velocities(f, t, h);
        const double jump = glm::length(v.before - v.after);
        ASSERT_LE(jump, 3e-3 * scale + rounding / h) << "at " << t << " of\n" << to_text(flight);
        ++checked;
      };
      check([&](double s) { return up_of(path.at(s)); }, 1e-14);
      // Altitude apart: to_camera's sum with the radius would round it away.
      check([&](double s) { return glm::dvec3(path.at(s).pose.alt_m, 0, 0); },
            1e-14 * std::abs(path.at(t).pose.alt_m));
      const auto platform = [&](double s) { return mars::to_camera(path.at(s).pose, kRadius_m).axes; };
      check([&](double s) { return platform(s).forward; }, 1e-13);
      check([&](double s) { return platform(s).up; }, 1e-13);
    }
  }
  EXPECT_GT(checked, 2000);
}

TEST(PathProperty, StatesAreFiniteContinuousAndWithinTheirKnots) {
  Random random(9);
  for (int n = 0; n < 300; ++n) {
    const Flight flight = random_flight(random);
    const Path path(flight, kRadius_m, {});
    for (std::size_t i = 0; i + 1 < flight.waypoints.size(); ++i) {
      const Waypoint& a = flight.waypoints[i];
      const Waypoint& b = flight.waypoints[i + 1];
      const auto [low, high] = std::minmax(a.up_m, b.up_m);
      FlightState before = path.at(a.time_s);
      for (int k = 1; k <= 100; ++k) {
        const FlightState state = path.at(std::min(b.time_s, a.time_s + (b.time_s - a.time_s) * k / 100.0));
        ASSERT_TRUE(state.pose.alt_m >= low && state.pose.alt_m <= high);
        ASSERT_TRUE(std::abs(state.head.pitch_deg) <= 90.0);
        ASSERT_TRUE(std::abs(glm::length(state.camera.axes.forward) - 1.0) < 1e-14);
        const mars::Axes platform = mars::to_camera(state.pose, kRadius_m).axes;
        ASSERT_TRUE(turned_rad(platform, mars::to_camera(before.pose, kRadius_m).axes) < 0.15);
        ASSERT_TRUE(mars::angle_between_rad(up_of(state), up_of(before)) < 0.1);
        before = state;
      }
    }
  }
}

TEST(PathProperty, StateAtAWaypointIsTheLineToTheBit) {
  Random random(9);
  for (int n = 0; n < 300; ++n) {
    const Flight flight = random_flight(random);
    const Path path(flight, kRadius_m, {});
    for (std::size_t i = 0; i < flight.waypoints.size(); ++i) {
      const Waypoint& w = flight.waypoints[i];
      const FlightState state = path.at(w.time_s);
      ASSERT_TRUE(state.pose.lon_deg == w.lon_deg && state.pose.lat_deg == w.lat_deg &&
                  state.pose.alt_m == w.up_m && state.pose.yaw_deg == w.yaw_deg &&
                  state.pose.pitch_deg == w.pitch_deg && state.pose.roll_deg == w.roll_deg);
      const HeadCommand& head = flight.heads[i];
      ASSERT_TRUE(state.head.yaw_deg == head.yaw_deg && state.head.pitch_deg == head.pitch_deg &&
                  state.head.roll_deg == head.roll_deg);
      ASSERT_TRUE(equal(state.camera.axes, mars::to_camera(state.pose, state.head, kRadius_m).axes));
      // And what comes right before and after it is next to it.
      const FlightState after = path.at(std::nextafter(w.time_s, 1e9));
      ASSERT_TRUE(turned_rad(after.camera.axes, state.camera.axes) < 1e-6);
      ASSERT_TRUE(glm::length(after.camera.position_m - state.camera.position_m) < 1e-6);
    }
  }
}

TEST(Path, TwoPosesFlyTheGreatCircleAtConstantSpeed) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const mars::LonLat a = mars::lon_lat(random.direction());
    const double bearing_deg = random.uniform(0, 360);
    const mars::LonLat b = mars::destination(a, bearing_deg, random.log_uniform(1e-6, 3.0));
    Flight flight;
    flight.waypoints = {waypoint(0, a, 1000, 0, 0), waypoint(16, b, 5000, 90, 0)};
    const Path path(flight, kRadius_m, {});
    for (int k = 0; k <= 16; ++k) {
      const FlightState state = path.at(k);
      const glm::dvec3 wanted = mars::slerp(mars::direction(a), mars::direction(b), k / 16.0);
      ASSERT_LT(glm::length(up_of(state) - wanted), 6e-15);
      ASSERT_NEAR(state.pose.alt_m, 1000 + 250.0 * k, 1e-11);
    }
  }
}

TEST(Path, StraightFlightAlongAGreatCircleKeepsItsPitch) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const mars::LonLat start = mars::lon_lat(random.direction());
    const double bearing_deg = random.uniform(0, 360);
    const double pitch = random.uniform(-80, 80);
    Flight flight;
    double t = 0;
    double way_rad = 0;
    for (int k = 0; k < 5; ++k) {
      const mars::LonLat place = mars::destination(start, bearing_deg, way_rad);
      // Heading at `place` away from the start: opposite to the bearing back.
      const double yaw_deg = k == 0 ? bearing_deg : mars::initial_bearing_deg(place, start) + 180.0;
      flight.waypoints.push_back(waypoint(t, place, 5000, yaw_deg, pitch));
      t += random.uniform(1, 10);
      way_rad += random.uniform(0.05, 0.7);
    }
    if (way_rad > 3.0) continue;
    const Path path(flight, kRadius_m, {});
    for (int k = 0; k <= 400; ++k) {
      ASSERT_NEAR(pitch_deg(path.at(path.duration_s() * k / 400.0)), pitch, 1e-6);
    }
  }
}

TEST(Path, CrossesThePolesWithoutSpin) {
  const char* over_north = "at 0 pose lon=0 lat=80 alt=1000 yaw=0 pitch=-10\n";
  const Path path = path_of(std::string(over_north) + "at 10 pose lon=180 lat=80 alt=1000 yaw=180 pitch=-10\n");
  const double step_rad = 20.0 * mars::kRadiansPerDegree / 1000;
  for (int k = 0; k < 1000; ++k) {
    const FlightState a = path.at(k / 100.0);
    const FlightState b = path.at((k + 1) / 100.0);
    ASSERT_NEAR(turned_rad(a.camera.axes, b.camera.axes), step_rad, 1e-7);
    ASSERT_NEAR(pitch_deg(b), -10, 1e-6);
  }
  EXPECT_NEAR(path.at(5).pose.lat_deg, 90, 1e-12);
  // A waypoint right on the pole, named by any meridian.
  for (const double lon : {0.0, 77.0, -180.0}) {
    const Path with_pole = path_of(std::string(over_north) + "at 5 pose lon=" + std::to_string(lon) +
                                   " lat=90 alt=1000 pitch=-10 yaw=" + std::to_string(lon) + "\n" +
                                   "at 10 pose lon=180 lat=80 alt=1000 yaw=180 pitch=-10\n");
    for (int k = 0; k <= 1000; ++k) {
      ASSERT_LT(glm::length(with_pole.at(k / 100.0).camera.axes.up - path.at(k / 100.0).camera.axes.up), 1e-8);
      ASSERT_LT(glm::length(with_pole.at(k / 100.0).camera.position_m - path.at(k / 100.0).camera.position_m),
                1e-2);
    }
  }
}

TEST(Path, CrossesTheAntimeridianOnTheShorterArc) {
  const Path path = path_of(
      "at 0 pose lon=170 lat=0 alt=0 yaw=90\n"
      "at 10 pose lon=-170 lat=0 alt=0 yaw=90\n"
      "at 20 pose lon=-150 lat=0 alt=0 yaw=90\n");
  const Path same = path_of(
      "at 0 pose lon=170 lat=0 alt=0 yaw=90\n"
      "at 10 pose lon=190 lat=0 alt=0 yaw=90\n"
      "at 20 pose lon=210 lat=0 alt=0 yaw=90\n");
  for (int k = 0; k <= 200; ++k) {
    const double lon = mars::normalize_lon_deg(170 + 40 * k / 200.0);
    ASSERT_NEAR(std::remainder(path.at(k / 10.0).pose.lon_deg - lon, 360), 0, 1e-12);
    ASSERT_NEAR(path.at(k / 10.0).pose.yaw_deg, 90, 1e-9);
    ASSERT_LT(glm::length(path.at(k / 10.0).camera.position_m - same.at(k / 10.0).camera.position_m), 1e-8);
  }
}

TEST(Path, TurnsInTheShorterDirection) {
  const Path path = path_of("at 0 pose lon=0 lat=0 alt=0 yaw=350\nat 2 pose lon=0 lat=0 alt=0 yaw=10\n");
  for (int k = 0; k <= 20; ++k)
    EXPECT_NEAR(std::remainder(path.at(k / 10.0).pose.yaw_deg - (350.0 + k), 360.0), 0, 1e-12);
}

TEST(Path, HoldsAreHoldsToTheBit) {
  const std::string pose = "pose lon=-60.1 lat=-13.7 alt=-1234.5 yaw=95.3 pitch=-7.7 roll=3.3\n";
  const Path path = path_of("at 0 pose lon=-70 lat=-10 alt=5000\nat 5 " + pose + "at 9 " + pose +
                            "at 12 pose lon=-50 lat=-12 alt=800\n");
  const FlightState held = path.at(5);
  for (int k = 0; k <= 400; ++k) {
    const FlightState state = path.at(5 + k / 100.0);
    ASSERT_EQ(state.camera.position_m, held.camera.position_m);
    ASSERT_TRUE(equal(state.camera.axes, held.camera.axes));
  }
  EXPECT_GT(glm::length(path.at(4.9).camera.position_m - held.camera.position_m), 1);
  EXPECT_GT(glm::length(path.at(9.1).camera.position_m - held.camera.position_m), 1);
}

TEST(Path, IsHeldBeforeTheFirstPoseAndAfterTheLast) {
  const Path path =
      path_of("at 2 pose lon=1 lat=2 alt=3 yaw=4 pitch=5 roll=6\nat 4 pose lon=2 lat=2 alt=9\nat 10 end\n");
  EXPECT_EQ(path.duration_s(), 10);
  for (const double t : {-5.0, 0.0, 1.0, 2.0, std::nan("")}) {
    EXPECT_EQ(path.at(t).pose.lon_deg, 1) << t;
    EXPECT_EQ(path.at(t).pose.roll_deg, 6) << t;
  }
  for (const double t : {4.0, 7.0, 10.0, 11.0, 1e300}) EXPECT_EQ(path.at(t).pose.alt_m, 9) << t;
  const Path single = path_of("at 0 pose lon=1 lat=2 alt=3\n");
  EXPECT_EQ(single.duration_s(), 0);
  EXPECT_EQ(single.at(1).pose.lat_deg, 2);
}

// A head that is held keeps its angles to the bit between `look` lines too, whatever its earlier motion.
TEST(Path, AHeadThatIsHeldIsHeldToTheBit) {
  const Path path(*parse_flight("flight 1\n"
                                "at 0 pose lon=0 lat=0 alt=1\n"
                                "at 1 look yaw=170.3 pitch=0.1 roll=-100.7\n"
                                "at 2 look yaw=-102.259 pitch=0.3 roll=100.1\n"
                                "at 5 look yaw=-102.259 pitch=0.3 roll=100.1\n"
                                "at 9 end\n",
                                "")
                       .flight,
                  mars::kMarsRadius_m, {});
  for (const double t : {2.0, 2.1, 3.7, 4.9, 5.0, 8.0, 9.0}) {
    const mars::HeadAngles head = path.at(t).head;
    EXPECT_EQ(head.yaw_deg, -102.259) << t;
    EXPECT_EQ(head.pitch_deg, 0.3) << t;
    EXPECT_EQ(head.roll_deg, 100.1) << t;
  }
}

TEST(Path, HeadTurnsSmoothlyInTheShorterDirectionAndIsHeldOutside) {
  const Path path = path_of(
      "at 0 pose lon=0 lat=0 alt=0\nat 2 look yaw=170\nat 4 look yaw=-170 pitch=10\nat 8 look yaw=-170 "
      "pitch=10\nat 10 end\n");
  EXPECT_EQ(path.at(0).head.yaw_deg, 170);
  EXPECT_EQ(path.at(2).head.yaw_deg, 170);
  EXPECT_NEAR(std::abs(path.at(3).head.yaw_deg), 180, 1e-12);
  EXPECT_NEAR(path.at(3).head.pitch_deg, 5, 1e-12);
  EXPECT_EQ(path.at(4).head.yaw_deg, -170);
  EXPECT_EQ(path.at(6).head.pitch_deg, 10);
  EXPECT_EQ(path.at(10).head.yaw_deg, -170);
  double before = 170;
  for (int k = 1; k <= 200; ++k) {
    const double step = std::remainder(path.at(2 + k / 100.0).head.yaw_deg - before, 360);
    ASSERT_GE(step, 0);
    ASSERT_LT(step, 0.2);
    before += step;
  }
  const FlightState state = path.at(4);
  EXPECT_TRUE(equal(state.camera.axes, mars::to_camera(state.pose, {-170, 10, 0}, kRadius_m).axes));
  const FlightState ahead = path_of("at 0 pose lon=0 lat=0 alt=0\n").at(0);
  EXPECT_EQ(ahead.head.yaw_deg, 0);
}

TEST(Path, SettingsHoldFromTheirTimeOn) {
  const Path path = path_of(
      "at 0 pose lon=0 lat=0 alt=0\nat 1 set mode=lit exaggeration=2\nat 2 set exaggeration=3\nat 2 set "
      "mode=unlit\n"
      "at 3 interest lon=1 lat=2 radius=3 levels=-4\nat 5 end\n");
  const auto at = [&](double t) {
    vpe::core::Settings settings;
    path.apply_settings(t, settings);
    return settings.values();
  };
  EXPECT_EQ(at(0.999).exaggeration, 1);
  EXPECT_EQ(at(1).exaggeration, 2);
  EXPECT_EQ(at(1).mode, vpe::core::Mode::kLit);
  EXPECT_EQ(at(2).exaggeration, 3);
  EXPECT_EQ(at(99).mode, vpe::core::Mode::kUnlit);
  EXPECT_TRUE(path.interests(2.9).empty());
  ASSERT_EQ(path.interests(3).size(), 1u);
  EXPECT_EQ(path.interests(3)[0].region.levels, -4);
}

Flight with_views(const std::string& views) {
  const ParsedFlight parsed = parse_flight(
      "flight 1.1\nview fov=60 size=64x48\n"
      "at 0 pose lon=0 lat=0 alt=1000\n" +
          views + "at 20 end\n",
      "F");
  EXPECT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  return *parsed.flight;
}

TEST(Path, ViewsHoldFromTheirTimeOn) {
  using vpe::core::DrawnBy;
  using vpe::core::StereoLayout;
  const Path path(
      with_views(
          "at 3 view backend=ray\nat 5 view eyes=ou base=4 convergence=60\nat 7 view eyes=off size=8x6\n"),
      mars::kMarsRadius_m, {});
  EXPECT_EQ(path.at(0).view, ViewState());
  EXPECT_EQ(path.at(std::nextafter(3, 0)).view, ViewState());
  EXPECT_EQ(path.at(3).view, (ViewState{{}, {}, DrawnBy::kRay, {}, {}, {}}));
  EXPECT_EQ(path.at(5).view, (ViewState{{}, {}, DrawnBy::kRay, Eyes{StereoLayout::kOverUnder}, 4, 60}));
  const ViewState last{{}, ImageSize{8, 6}, DrawnBy::kRay, Eyes{}, 4, 60};
  EXPECT_EQ(path.at(7).view, last);
  EXPECT_EQ(path.at(99).view, last);
  EXPECT_EQ(path.at(3).view, (ViewState{{}, {}, DrawnBy::kRay, {}, {}, {}}));  // also backwards
}

TEST(Path, ObjectsHaveATrackForEachName) {
  const ParsedFlight parsed = parse_flight(
      "flight 1.2\nat 0 pose lon=0 lat=0 alt=1000\nat 1 object b show=off\nat 2 object a lon=1 lat=2 heading=3\n"
      "at 4 object b lon=5 lat=6 show=on\nat 5 object a lon=7 lat=8 height=9\n",
      "F");
  ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  const Path path(*parsed.flight, mars::kMarsRadius_m, {});
  ASSERT_NE(path.tracks(), nullptr);
  using vpe::core::ObjectTrack;
  const std::vector<ObjectTrack> wanted{{"a", {{2, {1, 2, 0, 3}}, {5, {7, 8, 9, {}}}}, {}},
                                        {"b", {{4, {5, 6, 0, {}}}}, {{1, false}, {4, true}}}};
  EXPECT_EQ(*path.tracks(), wanted);
  EXPECT_TRUE(is_shown(wanted[1], 0.9));
  EXPECT_FALSE(is_shown(wanted[1], 1));
  EXPECT_FALSE(is_shown(wanted[1], 3.9));
  EXPECT_TRUE(is_shown(wanted[1], 4));
  EXPECT_EQ(Path(with_views(""), mars::kMarsRadius_m, {}).tracks(), nullptr);
}

TEST(Path, OppositePlacesOfAnObjectAreRefused) {
  const ParsedFlight parsed = parse_flight(
      "flight 1.2\nat 0 pose lon=0 lat=0 alt=1000\nat 1 object a lon=10 lat=20\nat 2 object a lon=190 lat=-20\n",
      "F");
  ASSERT_TRUE(parsed.flight.has_value());
  try {
    const Path path(*parsed.flight, mars::kMarsRadius_m, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("the object \"a\" is at 2 s opposite"), std::string::npos)
        << error.what();
  }
}

TEST(Path, TheFieldOfViewZoomsEvenlyBetweenItsLinesAndIsHeldOutside) {
  const Path path(with_views("at 10 view fov=60\nat 12 view fov=2\nat 14 view backend=ray\nat 16 view fov=2\n"),
                  mars::kMarsRadius_m, {});
  const auto fov = [&](double time_s) { return path.at(time_s).view.fov_deg.value(); };
  for (const double t : {0.0, 3.7, 10.0}) EXPECT_EQ(fov(t), 60);
  for (const double t : {12.0, 12.1, 14.0, 16.0, 19.0, 20.0, 30.0}) EXPECT_EQ(fov(t), 2);
  double before = 60;
  for (double t = 10.01; t < 12; t += 0.01) {
    EXPECT_LT(fov(t), before) << t;
    EXPECT_GE(fov(t), 2);
    before = fov(t);
  }
  const auto scale = [](double fov_deg) { return std::tan(fov_deg * mars::kRadiansPerDegree / 2); };
  EXPECT_NEAR(scale(fov(11)), std::sqrt(scale(60) * scale(2)), 1e-12);
}

// The view line without a time is where a zoom begins.
TEST(Path, AZoomBeginsWithTheFieldOfViewOfTheFlight) {
  const Path path(with_views("at 10 view fov=30\n"), mars::kMarsRadius_m, {});
  EXPECT_EQ(path.at(0).view.fov_deg, 60);
  EXPECT_LT(path.at(5).view.fov_deg, 59);
  EXPECT_GT(path.at(5).view.fov_deg, 31);
  EXPECT_EQ(path.at(10).view.fov_deg, 30);
  const Path own(with_views("at 0 view fov=20\n"), mars::kMarsRadius_m, {});
  for (const double t : {0.0, 4.0, 20.0}) EXPECT_EQ(own.at(t).view.fov_deg, 20);
}

TEST(PathProperty, FieldsOfViewAreThoseOfTheirLinesToTheBitAndNeverBeyond) {
  Random random(23);
  for (int n = 0; n < 300; ++n) {
    Flight flight;
    flight.waypoints.emplace_back();
    flight.view.fov_deg = random.log_uniform(0.001, 179);
    double t = random.integer(0, 1) == 0 ? 0 : random.uniform(0, 3);
    for (int k = random.integer(1, 12); k > 0; --k) {
      ViewCommand command{t, {}};
      if (random.integer(0, 4) == 0)
        command.view.eye_base_m = 1;
      else
        command.view.fov_deg = random.log_uniform(0.001, 179);
      flight.views.push_back(command);
      t += random.log_uniform(1e-6, 10);
    }
    const Path path(flight, mars::kMarsRadius_m, {});
    double from_s = 0;
    double from_deg = flight.view.fov_deg;
    for (const ViewCommand& command : flight.views) {
      if (!command.view.fov_deg) continue;
      const double to_deg = *command.view.fov_deg;
      ASSERT_EQ(path.at(command.time_s).view.fov_deg, to_deg);
      for (int k = 0; k < 20; ++k) {
        const double at_s = random.uniform(from_s, command.time_s);
        const double deg = *path.at(at_s).view.fov_deg;
        ASSERT_GE(deg, std::min(from_deg, to_deg));
        ASSERT_LE(deg, std::max(from_deg, to_deg));
      }
      from_s = command.time_s;
      from_deg = to_deg;
    }
  }
}

TEST(Path, HeightsAreAboveTheTerrain) {
  const Flight flight = flight_of("at 0 pose lon=10 lat=20 height=300\nat 1 pose lon=11 lat=20 alt=300\n");
  const Path path(flight, kRadius_m, [](mars::LonLat p, double) { return p.lon_deg * 100 + p.lat_deg; });
  EXPECT_EQ(path.at(0).pose.alt_m, 1320);
  EXPECT_EQ(path.at(1).pose.alt_m, 300);
}

void expect_throw(const std::string& lines, const TerrainHeight& terrain_m, const std::string& part) {
  try {
    const Path path(flight_of(lines), kRadius_m, terrain_m);
    FAIL() << lines;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Path, RefusesWhatCannotBeFlown) {
  const std::string low = "at 0 pose lon=0 lat=0 alt=1\nat 8.5 pose lon=10 lat=20 height=300\n";
  expect_throw(low, {}, "at 8.5 s has height=");
  expect_throw(
      low, [](mars::LonLat, double) { return std::nan(""); }, "lon 10 lat 20 is unknown");
  expect_throw("at 0 pose lon=0 lat=0 alt=-3396190\n", {}, "at 0 s lies at or below the planet's centre");
  expect_throw("at 0 pose lon=0 lat=10 alt=0\nat 4 pose lon=180 lat=-10 alt=0\n", {}, "at 4 s is opposite");
  EXPECT_NO_THROW(path_of("at 0 pose lon=0 lat=10 alt=0\nat 4 pose lon=180 lat=-10.001 alt=0\n"));
  EXPECT_THROW(Path(Flight{}, kRadius_m, {}), std::runtime_error);
}

TEST(Clearance, FindsTheLowestFrame) {
  const Path path = path_of("at 0 pose lon=0 lat=0 alt=1000\nat 10 pose lon=10 lat=0 alt=1000\n");
  const TerrainHeight peak = [](mars::LonLat p, double) { return 900 - 100 * std::abs(p.lon_deg - 7.0); };
  const std::optional<Clearance> lowest = lowest_clearance(path, {10, 1}, peak);
  ASSERT_TRUE(lowest.has_value());
  EXPECT_EQ(lowest->frame, 70);
  EXPECT_EQ(lowest->time_s, 7);
  EXPECT_NEAR(lowest->height_m, 100, 1e-9);
  EXPECT_NEAR(lowest->place.lon_deg, 7, 1e-12);
  EXPECT_FALSE(lowest_clearance(path, {10, 1}, [](mars::LonLat, double) { return std::nan(""); }).has_value());
}

}  // namespace
TEST(Path, HeightsAreAboveTheTerrainAsItIsDrawnThen) {
  const auto parsed = scripts::parse_flight(
      "flight 1\nview fov=60 size=64x64 fps=10\nat 0 pose lon=0 lat=0 height=100\n"
      "at 2 set exaggeration=3\nat 2 pose lon=1 lat=0 height=100\nat 4 pose lon=2 lat=0 alt=100\n"
      "at 5 set exaggeration=0.5\nat 6 pose lon=3 lat=0 height=100\n",
      "test");
  ASSERT_TRUE(parsed.flight);
  const auto terrain = [](mars::LonLat, double x) { return 1000.0 * x; };
  const scripts::Path path(*parsed.flight, 3396190.0, terrain, 2.0);
  EXPECT_EQ(path.exaggeration(1.9), 2.0);
  EXPECT_EQ(path.exaggeration(2.0), 3.0);
  EXPECT_EQ(path.at(0).pose.alt_m, 2100.0);
  EXPECT_EQ(path.at(2).pose.alt_m, 3100.0);
  EXPECT_EQ(path.at(4).pose.alt_m, 100.0);
  EXPECT_EQ(path.at(6).pose.alt_m, 600.0);
  // 100 m high where 3 km of ground are drawn.
  const auto lowest = scripts::lowest_clearance(path, parsed.flight->view.fps, terrain);
  ASSERT_TRUE(lowest);
  EXPECT_NEAR(lowest->height_m, -2900.0, 60.0);
}

}  // namespace scripts
