#include "scripts/log.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "scripts/path.h"
#include "scripts/stats.h"
#include "tests/support/support.h"

namespace scripts {
namespace {

using test_support::Random;
using test_support::TempDir;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

constexpr const char* kFlight =
    "flight 1\n"
    "view fov=50 size=640x360 fps=30000/1001\n"
    "at 0 pose lon=-74 lat=-13.5 alt=12000 yaw=90 pitch=-15\n"
    "at 0 set mode=lit\n"
    "at 2 look yaw=0\n"
    "at 3 look yaw=40 pitch=5\n"
    "at 3 pose lon=-68 lat=-89.2 alt=3000 yaw=100 pitch=-10 roll=-20\n"
    "at 4 set exaggeration=2.25 sun.azimuth=10\n"
    "at 6 pose lon=130 lat=-80 alt=900 yaw=-100 pitch=-10 roll=20\n"
    "at 7 end\n";

// Writes the log of a film of `flight`.
void write_log(const std::filesystem::path& file, const Flight& flight, const Path& path, bool end) {
  FlightLog log(file, flight.view);
  const std::int64_t frames = frame_count(flight.view.fps, path.duration_s());
  for (std::int64_t k = 0; k < frames; ++k) {
    const double t = frame_time(flight.view.fps, k);
    const FlightState state = path.at(t);
    vpe::core::Settings settings;
    path.apply_settings(t, settings);
    std::vector<vpe::core::InterestRegion> regions;
    if (k >= 10) regions.push_back({1, 2, 3, -1});
    if (k >= 20) regions.push_back({4, 5, 6, 7});
    if (k >= 20) regions.push_back({4, 5, 6, 7});
    log.frame(t, state.pose, state.head, settings, regions);
  }
  if (end) log.end(frame_time(flight.view.fps, frames));
}

TEST(FlightLog, ReplaysToTheBit) {
  const Flight flight = *parse_flight(kFlight, "").flight;
  const Path path(flight, mars::kMarsRadius_m, {});
  for (const bool end : {true, false}) {
    const TempDir folder;
    write_log(folder / "log.flight", flight, path, end);
    const ParsedFlight parsed = parse_flight(read_file(folder / "log.flight"), "log.flight");
    ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
    EXPECT_EQ(parsed.flight->view, flight.view);
    const double later_s = frame_time(flight.view.fps, 20);
    EXPECT_EQ(parsed.flight->interests,
              (std::vector<InterestCommand>{{frame_time(flight.view.fps, 10), {1, 2, 3, -1}},
                                            {later_s, {4, 5, 6, 7}},
                                            {later_s, {4, 5, 6, 7}}}));
    const Path replay(*parsed.flight, mars::kMarsRadius_m, {});
    const std::int64_t frames = frame_count(flight.view.fps, path.duration_s());
    const std::int64_t replayed = frame_count(flight.view.fps, replay.duration_s());
    EXPECT_EQ(replayed, end ? frames : frames - 1);
    for (std::int64_t k = 0; k < frames; ++k) {
      const double t = frame_time(flight.view.fps, k);
      const mars::CameraPose a = path.at(t).camera;
      const mars::CameraPose b = replay.at(t).camera;
      ASSERT_EQ(a.position_m, b.position_m) << k;
      ASSERT_EQ(a.axes.right, b.axes.right) << k;
      ASSERT_EQ(a.axes.up, b.axes.up) << k;
      ASSERT_EQ(a.axes.forward, b.axes.forward) << k;
      vpe::core::Settings wanted, got;
      path.apply_settings(t, wanted);
      replay.apply_settings(t, got);
      ASSERT_EQ(wanted, got) << k;
    }
  }
}

TEST(FlightLog, HeadStaysStillUntilItMoves) {
  const TempDir folder;
  {
    FlightLog log(folder / "log.flight", {});
    for (int k = 0; k < 6; ++k) log.frame(k, {}, {k < 4 ? 0.0 : 30.0, 0, 0}, {});
    log.end(6);
  }
  const Path replay(*parse_flight(read_file(folder / "log.flight"), "").flight, mars::kMarsRadius_m, {});
  for (int k = 0; k <= 30; ++k) EXPECT_EQ(replay.at(k / 10.0).head.yaw_deg, 0);
  for (int k = 40; k <= 60; ++k) EXPECT_EQ(replay.at(k / 10.0).head.yaw_deg, 30);
}

// Views replay to the bit at the frames, and stand still until they change.
TEST(FlightLog, ViewsReplayToTheBit) {
  using vpe::core::DrawnBy;
  Random random(31);
  const TempDir folder;
  struct Seen {
    double time_s;
    ViewState view;
  };
  std::vector<Seen> seen;
  {
    FlightLog log(folder / "log.flight", {}, LineFile::Mode::kLive, FlightVersion::k1_1);
    double t = 2.5;
    ViewState view{50, ImageSize{64, 48}, DrawnBy::kRay, Eyes{}, {}, {}};
    for (int k = 0; k < 300; ++k) {
      if (random.integer(0, 3) == 0) view.fov_deg = random.log_uniform(1, 140);
      if (random.integer(0, 9) == 0) view.size = ImageSize{k + 1, 48};
      if (random.integer(0, 9) == 0) view.backend = static_cast<DrawnBy>(random.integer(0, 2));
      if (random.integer(0, 9) == 0) {
        view.eyes = Eyes{static_cast<vpe::core::StereoLayout>(random.integer(0, 2))};
        view.eye_base_m = random.uniform(0, 100);
        view.convergence_m = random.uniform(0, 1000);
      }
      log.frame(t, {}, {}, {}, {}, view);
      seen.push_back({t, view});
      t += random.log_uniform(1e-4, 1);
      ASSERT_TRUE(parse_flight(read_file(folder / "log.flight"), "").flight.has_value());
    }
    log.end(t);
  }
  const Flight flight = *parse_flight(read_file(folder / "log.flight"), "").flight;
  const Path replay(flight, mars::kMarsRadius_m, {});
  EXPECT_EQ(replay.at(0).view, seen.front().view);
  int zooms = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    ASSERT_EQ(replay.at(seen[k].time_s).view, seen[k].view) << k;
    if (k == 0) continue;
    const double between_s = 0.5 * (seen[k - 1].time_s + seen[k].time_s);
    if (seen[k].view.fov_deg == seen[k - 1].view.fov_deg) {
      ASSERT_EQ(replay.at(between_s).view.fov_deg, seen[k].view.fov_deg);
    } else {
      ++zooms;
    }
  }
  EXPECT_GT(zooms, 20);
}

TEST(FlightLog, OfVersion1HasNoViews) {
  const TempDir folder;
  FlightLog log(folder / "log.flight", {});
  ViewState view;
  view.fov_deg = 30;
  EXPECT_THROW(log.frame(0, {}, {}, {}, {}, view), std::logic_error);
  log.frame(0, {}, {}, {});
  EXPECT_TRUE(read_file(folder / "log.flight").starts_with("flight 1\n# log of vpe\n"));
}

TEST(FlightLog, HasTheLinesOfObjectsAtTheirTimes) {
  const TempDir folder;
  const std::vector<ObjectCommand> lines{{0.5, "a b", vpe::core::ObjectPlace{1, 2, 3, 4}, {}},
                                         {1, "c", {}, false},
                                         {2.5, "a b", vpe::core::ObjectPlace{2, 2, 3, {}}, true}};
  EXPECT_THROW(FlightLog(folder / "old.flight", {}, LineFile::Mode::kLive, FlightVersion::k1_1).objects(lines),
               std::logic_error);
  FlightLog log(folder / "log.flight", {}, LineFile::Mode::kLive, FlightVersion::k1_2);
  log.objects(lines);
  for (int k = 0; k < 3; ++k) {
    log.frame(k, {1.0 * k, 2, 3, 4, 5, 6}, {}, {});
    const ParsedFlight parsed = parse_flight(read_file(folder / "log.flight"), "log.flight");
    ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
    EXPECT_EQ(parsed.flight->objects.size(), k == 0 ? 0U : 2U);
  }
  log.end(3);
  const ParsedFlight parsed = parse_flight(read_file(folder / "log.flight"), "log.flight");
  ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  EXPECT_EQ(parsed.flight->objects, lines);
}

TEST(FlightLog, HasTheLinesOfTheGroundAtTheirTimes) {
  const TempDir folder;
  const std::vector<ReliefCommand> reliefs{{0.5, "a b", "kind=crater lon=1 lat=2 radius=30", {}},
                                           {2.5, "a b", "radius=40", false}};
  const std::vector<PatchCommand> patches{{0.5, "b c.vpe", 0}, {0.75, "b c.vpe", 1}};
  EXPECT_THROW(
      FlightLog(folder / "old.flight", {}, LineFile::Mode::kLive, FlightVersion::k1_2).ground(reliefs, patches),
      std::logic_error);
  FlightLog log(folder / "log.flight", {}, LineFile::Mode::kLive, FlightVersion::k1_3);
  log.ground(reliefs, patches);
  for (int k = 0; k < 3; ++k) {
    log.frame(k, {1.0 * k, 2, 3, 4, 5, 6}, {}, {});
    const ParsedFlight parsed = parse_flight(read_file(folder / "log.flight"), "log.flight");
    ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
    EXPECT_EQ(parsed.flight->reliefs.size(), k == 0 ? 0U : 1U);
  }
  log.end(3);
  const ParsedFlight parsed = parse_flight(read_file(folder / "log.flight"), "log.flight");
  ASSERT_TRUE(parsed.flight.has_value()) << to_string(parsed.errors.at(0));
  EXPECT_EQ(parsed.flight->reliefs, reliefs);
  EXPECT_EQ(parsed.flight->patches, patches);
}

TEST(FlightLog, IsAValidFlightAtAnyMoment) {
  const TempDir folder;
  FlightLog log(folder / "log.flight", {});
  for (int k = 0; k < 5; ++k) {
    log.frame(k, {1.0 * k, 2, 3, 4, 5, 6}, {}, {});
    const ParsedFlight parsed = parse_flight(read_file(folder / "log.flight"), "log.flight");
    ASSERT_TRUE(parsed.flight.has_value());
    EXPECT_EQ(parsed.flight->waypoints.size(), static_cast<std::size_t>(k + 1));
  }
}

TEST(FlightLog, ErrorsNameTheFileAndTheReason) {
  const TempDir folder;
  try {
    FlightLog(folder / "absent" / "log.flight", {});
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("absent/log.flight: cannot open for writing: No such file"), std::string::npos) << text;
  }
  try {
    FlightLog("/dev/full", {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full: cannot write: No space left"), std::string::npos)
        << error.what();
  }
}

vpe::core::FrameStats some_stats() {
  vpe::core::FrameStats stats;
  stats.tiles_visited = 200;
  stats.tiles_drawn = 150;
  stats.triangles = 5'000'000'000;
  stats.tiles_by_level = {0, 2, 148};
  stats.draw_ms = 12.625;
  return stats;
}

vpe::core::Certificate some_certificate() {
  vpe::core::Certificate certificate;
  certificate.geometric_error_m = 3.5;
  certificate.screen_space_error_px = 0.75;
  certificate.shift_bound_px = std::numeric_limits<double>::infinity();
  return certificate;
}

std::vector<std::string> split(const std::string& line, char by) {
  std::vector<std::string> parts;
  std::stringstream stream(line);
  for (std::string part; std::getline(stream, part, by);) parts.push_back(part);
  return parts;
}

TEST(StatsWriter, CsvHasAHeaderAndARowAFrame) {
  const TempDir folder;
  StatsWriter writer(folder / "s.csv");
  writer.row(0, 0, some_stats(), some_certificate());
  writer.row(1, 1.0 / 30, {}, {});
  writer.close();
  const std::vector<std::string> lines = split(read_file(folder / "s.csv"), '\n');
  ASSERT_EQ(lines.size(), 3u);
  const std::vector<std::string> names = split(lines[0], ',');
  const std::vector<std::string> values = split(lines[1], ',');
  ASSERT_EQ(names.size(), values.size());
  ASSERT_EQ(names.size(), split(lines[2], ',').size());
  const auto value = [&](const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return values[i];
    }
    return std::string("no column ") + name;
  };
  EXPECT_EQ(names[0], "frame");
  EXPECT_EQ(names[1], "t_s");
  EXPECT_EQ(value("tiles_visited"), "200");
  EXPECT_EQ(value("triangles"), "5000000000");
  EXPECT_EQ(value("tiles_by_level"), "0;2;148");
  EXPECT_EQ(value("draw_ms"), "12.625");
  EXPECT_EQ(value("tile_error_m"), "3.5");
  EXPECT_EQ(value("tile_error_px"), "0.75");
  EXPECT_EQ(value("shift_bound_px"), "");
}

TEST(StatsWriter, JsonLinesAreObjectsWithTheSameFields) {
  const TempDir folder;
  StatsWriter json(folder / "s.jsonl");
  StatsWriter csv(folder / "s.csv");
  json.row(7, 0.1, some_stats(), some_certificate());
  csv.row(7, 0.1, some_stats(), some_certificate());
  EXPECT_FALSE(std::filesystem::exists(folder / "s.csv"));
  json.close();
  csv.close();
  const nlohmann::json row = nlohmann::json::parse(read_file(folder / "s.jsonl"));
  EXPECT_EQ(row["frame"], 7);
  EXPECT_EQ(row["t_s"], 0.1);
  EXPECT_EQ(row["triangles"], 5'000'000'000);
  EXPECT_EQ(row["tiles_by_level"], (std::vector<int>{0, 2, 148}));
  EXPECT_EQ(row["tile_error_px"], 0.75);
  EXPECT_TRUE(row["shift_bound_px"].is_null());
  const std::vector<std::string> names = split(split(read_file(folder / "s.csv"), '\n')[0], ',');
  EXPECT_EQ(row.size(), names.size());
  for (const std::string& name : names) EXPECT_TRUE(row.contains(name)) << name;
}

TEST(StatsWriter, ExtensionDecidesAndOthersAreRefused) {
  const TempDir folder;
  try {
    StatsWriter writer(folder / "s.xlsx");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("name it .csv or .jsonl"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "s.xlsx"));
}

}  // namespace
}  // namespace scripts
