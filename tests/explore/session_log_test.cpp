#include "vpe/explore/files/session_log.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "scripts/path.h"
#include "tests/support/support.h"

namespace vpe::explore {
namespace {

using test_support::Random;

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

bool equal(const mars::Pose& a, const mars::Pose& b) {
  return a.lon_deg == b.lon_deg && a.lat_deg == b.lat_deg && a.alt_m == b.alt_m && a.yaw_deg == b.yaw_deg &&
         a.pitch_deg == b.pitch_deg && a.roll_deg == b.roll_deg;
}

class SessionLogs : public ::testing::Test {
 protected:
  scripts::Flight flight() const {
    const scripts::ParsedFlight parsed = scripts::parse_flight(read_text(path_), "log");
    EXPECT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
    return parsed.flight.value_or(scripts::Flight());
  }
  scripts::Path replay() const { return {flight(), mars::kMarsRadius_m, {}}; }

  test_support::TempDir folder_;
  std::filesystem::path path_ = folder_ / "s.flight";
  SessionLog log_{path_, {50, 640, 360, {30, 1}}, mars::kMarsRadius_m};
};

// Logs motions, pauses, jumps and changes of settings. At every frame's time the replay equals the session.
TEST_F(SessionLogs, ReplayToTheBit) {
  Random random(11);
  struct Seen {
    SessionLog::Frame frame;
    core::Settings settings;
  };
  std::vector<Seen> seen;
  core::Settings settings;
  SessionLog::Frame frame{0, {10, 20, 5000, 0, -10, 0}, {}};
  for (int n = 0; n < 400; ++n) {
    frame.time_s += random.integer(0, 9) == 0 ? random.uniform(1, 60) : random.uniform(0.005, 0.05);
    if (random.integer(0, 20) == 0) {
      const mars::LonLat p = mars::lon_lat(random.direction());
      frame.pose = {p.lon_deg,
                    p.lat_deg,
                    random.uniform(-4000, 1e6),
                    random.uniform(-180, 180),
                    random.uniform(-90, 90),
                    random.uniform(-180, 180)};
    } else {
      frame.pose.lat_deg = std::clamp(frame.pose.lat_deg + random.uniform(-1e-3, 1e-3), -90.0, 90.0);
      frame.pose.yaw_deg = std::clamp(frame.pose.yaw_deg + random.uniform(-1, 1), -180.0, 180.0);
    }
    if (random.integer(0, 3) == 0) frame.look = {random.uniform(-180, 180), random.uniform(-90, 90), 0};
    if (n % 50 == 7) {
      ASSERT_EQ(settings.set("exaggeration", std::to_string(1 + n / 10)), "");
    }
    if (n % 60 == 9) {
      ASSERT_EQ(settings.set("mode", n % 120 == 9 ? "wireframe" : "textured"), "");
    }
    if (n == 200) log_.enter_overlook(frame.time_s, "a \"spot\"", "/p/a b.json");
    if (n == 250) log_.leave_overlook(frame.time_s);
    const auto time_s = log_.frame(frame, settings);
    ASSERT_EQ(time_s, frame.time_s);
    seen.push_back({frame, settings});
  }
  log_.end(frame.time_s + 1);
  const scripts::Path path = replay();
  EXPECT_EQ(path.duration_s(), frame.time_s + 1);
  for (const Seen& s : seen) {
    const scripts::FlightState state = path.at(s.frame.time_s);
    EXPECT_TRUE(equal(state.pose, s.frame.pose)) << s.frame.time_s;
    EXPECT_EQ(state.head.yaw_deg, s.frame.look.yaw_deg);
    EXPECT_EQ(state.head.pitch_deg, s.frame.look.pitch_deg);
    core::Settings then;
    path.apply_settings(s.frame.time_s, then);
    EXPECT_EQ(then, s.settings);
  }
  const auto steps = overlook_steps(read_text(path_));
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_TRUE(steps[0].in);
  EXPECT_EQ(steps[0].time_s, seen[200].frame.time_s);
  EXPECT_EQ(steps[0].hotspot, "a \"spot\"");
  EXPECT_EQ(steps[0].panorama, "/p/a b.json");
  EXPECT_FALSE(steps[1].in);
  EXPECT_EQ(steps[1].time_s, seen[250].frame.time_s);
}

// The window drew nothing for a minute, so nothing moves in the replay.
TEST_F(SessionLogs, TheCameraStandsStillInAPause) {
  const mars::Pose here{10, 20, 5000, 0, -10, 0};
  const mars::Pose there{11, 20, 6000, 40, -10, 0};
  log_.frame({0, here, {}}, {});
  log_.frame({60, there, {30, 0, 0}}, {});
  log_.frame({120, there, {30, 0, 0}}, {});
  const scripts::Path path = replay();
  for (const double t : {0.5, 30.0, 59.95}) {
    EXPECT_TRUE(equal(path.at(t).pose, here)) << t;
    EXPECT_EQ(path.at(t).head.yaw_deg, 0);
  }
  EXPECT_TRUE(equal(path.at(60).pose, there));
  EXPECT_TRUE(equal(path.at(90).pose, there));
  EXPECT_EQ(flight().waypoints.size(), 4U);  // no hold where nothing moved
}

// A zoom after a pause begins with the image, not with the pause.
TEST_F(SessionLogs, TheFieldOfViewStandsStillInAPause) {
  const mars::Pose here{10, 20, 5000, 0, -10, 0};
  const auto view = [](double fov_deg) {
    scripts::ViewState state;
    state.fov_deg = fov_deg;
    return state;
  };
  log_.frame({1, here, {}, view(50)}, {});
  log_.frame({60, here, {}, view(20)}, {});
  log_.frame({61, here, {}}, {});  // as a panorama, which has no field of view of the session
  const scripts::Path path = replay();
  for (const double t : {0.0, 1.0, 30.0, 59.95}) EXPECT_EQ(path.at(t).view.fov_deg, 50) << t;
  EXPECT_LT(path.at(59.99).view.fov_deg, 50);
  EXPECT_GT(path.at(59.99).view.fov_deg, 20);
  for (const double t : {60.0, 60.5, 61.0, 70.0}) EXPECT_EQ(path.at(t).view.fov_deg, 20) << t;
  EXPECT_FALSE(log_.frame({62, here, {}, view(0)}, {}).has_value());
  EXPECT_FALSE(log_.frame({62, here, {}, view(std::nan(""))}, {}).has_value());
}

TEST_F(SessionLogs, RegionsAreAddedAndRemoved) {
  const core::InterestRegion a{1, 2, 3000, 2};
  const core::InterestRegion b{400, 5, 6000, -1};
  const std::vector<core::InterestRegion> both{a, b}, twice{b, b}, none;
  log_.frame({0, {}, {}}, {}, both);
  log_.frame({0.1, {}, {}}, {}, both);
  log_.frame({0.2, {}, {}}, {}, twice);
  log_.frame({0.3, {}, {}}, {}, none);
  const auto told = flight().interests;
  const auto levels_at = [&](double time_s, double lon_deg) {
    int levels = 0;
    for (const scripts::InterestCommand& i : told)
      levels += i.time_s <= time_s && i.region.lon_deg == lon_deg ? i.region.levels : 0;
    return levels;
  };
  EXPECT_EQ(levels_at(0, 1), 2);
  EXPECT_EQ(levels_at(0.1, 40), -1);
  EXPECT_EQ(levels_at(0.2, 1), 0);
  EXPECT_EQ(levels_at(0.2, 40), -2);
  EXPECT_EQ(levels_at(0.3, 40), 0);
  EXPECT_EQ(told.size(), 6U);
}

TEST_F(SessionLogs, AJumpToTheOtherSideOfThePlanetReplays) {
  const mars::Pose here{10, 20, 5000, 0, -10, 0};
  const mars::Pose opposite{-170, -20, 5000, 0, -10, 0};
  log_.frame({0, here, {}}, {});
  EXPECT_EQ(log_.frame({0.02, opposite, {}}, {}), 0.02);
  EXPECT_EQ(log_.frame({50, here, {}}, {}), 50);
  const scripts::Path path = replay();
  EXPECT_TRUE(equal(path.at(0).pose, here));
  EXPECT_TRUE(equal(path.at(0.02).pose, opposite));
  EXPECT_TRUE(equal(path.at(49.9).pose, opposite));
  EXPECT_TRUE(equal(path.at(50).pose, here));
}

TEST_F(SessionLogs, TheFileIsAlwaysAFlight) {
  const double nan = std::nan("");
  const mars::Pose pose{10, 20, 5000, 0, -10, 0};
  EXPECT_EQ(log_.frame({1, pose, {}}, {}), 1);
  const auto same_time = log_.frame({1, {11, 20, 5000, 0, -10, 0}, {}}, {});
  ASSERT_TRUE(same_time.has_value());
  EXPECT_GT(*same_time, 1);
  EXPECT_LT(*same_time, 1 + 1e-12);
  EXPECT_GT(log_.frame({0.5, pose, {}}, {}).value_or(0), *same_time);
  EXPECT_FALSE(log_.frame({2, {nan, 20, 5000, 0, 0, 0}, {}}, {}).has_value());
  EXPECT_FALSE(log_.frame({2, pose, {0, 91, 0}}, {}).has_value());
  EXPECT_FALSE(log_.frame({2, {0, 0, -4e6, 0, 0, 0}, {}}, {}).has_value());
  EXPECT_FALSE(log_.frame({2e6, pose, {}}, {}).has_value());
  EXPECT_EQ(log_.frame({3, {370, 20, 5000, 725, 0, 0}, {}}, {}), 3);
  log_.note(3, "two\nlines\rhere");
  log_.enter_overlook(3, "", "a\nb");
  log_.end(0);
  const scripts::Flight f = flight();
  EXPECT_NEAR(f.waypoints.back().lon_deg, 10, 1e-12);
  EXPECT_NEAR(f.waypoints.back().yaw_deg, 5, 1e-12);
  EXPECT_EQ(f.end_s, 3);
  EXPECT_EQ(f.waypoints.size(), 5U);  // with the pause before the last
  EXPECT_NE(read_text(path_).find("# at 3 two lines here\n"), std::string::npos);
}

TEST(OverlookSteps, OtherTextHasNone) {
  EXPECT_TRUE(overlook_steps("").empty());
  EXPECT_TRUE(overlook_steps("flight 1\n# at x overlook out\n# at 1 overlook in a\n# at 1 overlook\n"
                             "at 1 overlook out\n# at 1 overlook in \"a b\n\x01\xff")
                  .empty());
  EXPECT_EQ(overlook_steps("# at 1 overlook out\r\n# at 2 overlook in a b").size(), 2U);
}

}  // namespace
}  // namespace vpe::explore
