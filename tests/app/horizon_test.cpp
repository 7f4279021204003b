// vpe horizon.
#include <cmath>
#include <csignal>
#include <sstream>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

std::vector<std::vector<double>> read_csv(const std::string& text, std::string* head = nullptr) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  if (head != nullptr) *head = line;
  std::vector<std::vector<double>> out;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    auto& row = out.emplace_back();
    while (std::getline(fields, field, ',')) row.push_back(std::stod(field));
  }
  return out;
}

class Horizon : public AppTest {
 protected:
  Words words(const Words& more) const {
    Words out{"horizon", planet().string(), "--at", "20,10"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  json ask(const Words& more) const {
    Words all = words(more);
    all.push_back("--json");
    const Result result = vpe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  }
};

TEST_F(Horizon, TheFullCircleAndItsSummary) {
  const json summary = ask({"--height", "500", "-o", "s.csv", "--step", "0.5"});
  std::string head;
  const auto rows = read_csv(read_text(dir_ / "s.csv"), &head);
  EXPECT_EQ(head, "azimuth_deg,elevation_deg,range_m,lon_deg,lat_deg,elevation_m");
  ASSERT_EQ(rows.size(), 720U);
  EXPECT_EQ(summary["azimuths"], 720);
  EXPECT_EQ(summary["eye"]["height_m"], 500);
  double highest = -90;
  double farthest = 0;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    EXPECT_EQ(rows[n][0], 0.5 * static_cast<double>(n));
    highest = std::max(highest, rows[n][1]);
    farthest = std::max(farthest, rows[n][2]);
  }
  EXPECT_NEAR(summary["highest"]["elevation_deg"].get<double>(), highest, 1e-7);
  EXPECT_GE(summary["farthest"]["range_m"].get<double>(), farthest - 0.001);
  // East is to the right of north, and the ground is what query says.
  EXPECT_GT(rows[180][3], 20.01);
  EXPECT_NEAR(rows[180][4], 10, 1);
  EXPECT_GT(rows[0][4], 10.01);
  EXPECT_NEAR(rows[0][3], 20, 1e-6);
  for (const std::size_t n : {0U, 100U, 333U}) {
    std::ostringstream place;
    place.precision(12);
    place << rows[n][3] << "," << rows[n][4];
    const json answer = parse_json(vpe({"query", planet().string(), "--json", place.str()}).out)[0];
    EXPECT_NEAR(answer["elevation_m"].get<double>(), rows[n][5], 0.01);
  }
}

TEST_F(Horizon, AnArcHasTheSameNumbers) {
  ASSERT_EQ(vpe(words({"--height", "2", "-o", "all.csv", "--step", "1"})).exit_code, 0);
  ASSERT_EQ(
      vpe(words({"--height", "2", "-o", "arc.csv", "--step", "1", "--from", "-3", "--to", "4"})).exit_code, 0);
  const auto all = read_csv(read_text(dir_ / "all.csv"));
  const auto arc = read_csv(read_text(dir_ / "arc.csv"));
  ASSERT_EQ(arc.size(), 8U);  // both ends
  for (int n = 0; n < 8; ++n) {
    const auto& twin = all[static_cast<std::size_t>((n + 357) % 360)];
    const auto& row = arc[static_cast<std::size_t>(n)];
    EXPECT_EQ(row[0], (n + 357) % 360);
    EXPECT_NEAR(row[1], twin[1], 2e-7);
  }
}

TEST_F(Horizon, FromOrbitAndAtAPole) {
  const json orbit = ask({"--altitude", "4e6", "-o", "o.csv", "--step", "10"});
  const double radius = orbit["radius_m"];
  // The dip of the sphere, apart from hills and the sagitta of facets 42 km wide.
  const double dip = std::acos(radius / (radius + 4e6)) * 180 / M_PI;
  EXPECT_GT(dip, 60);
  EXPECT_NEAR(orbit["highest"]["elevation_deg"].get<double>(), -dip, 0.1);
  EXPECT_NEAR(orbit["lowest"]["elevation_deg"].get<double>(), -dip, 0.1);
  const Result pole = vpe(
      {"horizon", planet().string(), "--at", "30,-90", "--height", "2", "-o", "p.csv", "--step", "45", "-q"});
  ASSERT_EQ(pole.exit_code, 0) << pole.err;
  EXPECT_EQ(pole.out, "");
  // North at the south pole is along the meridian of the place.
  const auto rows = read_csv(read_text(dir_ / "p.csv"));
  EXPECT_NEAR(rows[0][3], 30, 1e-6);
  EXPECT_NEAR(rows[2][3], 120, 1e-6);
}

TEST_F(Horizon, NamedFeatures) {
  write_text(dir_ / "n.csv",
             "name,lon,lat,diameter_km\n\"near, by\",20.01,10,\nbehind,20,14,10\nplain,20,10,900\n"
             "other side,-160,-10,50\n");
  const json summary = ask({"--height", "100", "-o", "s.csv", "--step", "5", "--names", "n.csv", "--features",
                            "f.csv", "--within", "3e5"});
  EXPECT_EQ(summary["features_visible"].get<int>() + summary["features_hidden"].get<int>(), 3);
  bool behind = false;
  for (const json& f : summary["features"]) {
    if (f["name"] == "near, by") {
      EXPECT_TRUE(f["visible"].get<bool>());
      EXPECT_NEAR(f["azimuth_deg"].get<double>(), 90, 0.01);
    }
    if (f["name"] != "behind") continue;
    behind = true;  // 237 km away, far past the horizon
    EXPECT_FALSE(f["visible"].get<bool>());
    EXPECT_EQ(f["hidden_by"]["name"], "plain");
    EXPECT_LT(f["hidden_by"]["range_m"].get<double>(), f["range_m"].get<double>());
  }
  EXPECT_TRUE(behind);
  const std::string csv = read_text(dir_ / "f.csv");
  EXPECT_NE(csv.find("\n\"near, by\",20.01,10,,89.99"), std::string::npos) << csv;
  // Just west of north: no azimuth of 360.
  EXPECT_NE(csv.find("\nbehind,20,14,10,0.0000000,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",plain\n"), std::string::npos) << csv;
}

// A tower of 3 km stands 20 km north of the camera, and a place 60 km behind it.
TEST_F(Horizon, ObjectsRiseAboveTheSkylineAndHideFeatures) {
  write_text(
      dir_ / "tower.obj",
      "v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 1 -0.5\nv -0.5 1 -0.5\nv -0.5 0 0.5\nv 0.5 0 0.5\nv 0.5 1 0.5\n"
      "v -0.5 1 0.5\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  write_text(dir_ / "a.scene.toml",
             "version = 1\n[[model]]\nname = \"tower\"\nfile = \"tower.obj\"\n[[object]]\nmodel = \"tower\"\n"
             "name = \"the tower, white\"\nlon = 20\nlat = 10.338\nscale = 3000\n");
  write_text(dir_ / "names.csv", "name,lon,lat\nBehind,20,11.014\nBeside,20.5,11.014\n");
  const Words common{"--height", "20000",  "--from", "-10",     "--to",
                     "10",       "--step", "0.5",    "--names", "names.csv"};
  const auto with = [&](const Words& more) {
    Words all = common;
    all.insert(all.end(), more.begin(), more.end());
    return ask(all);
  };
  const json bare = with({"-o", "bare.csv"});
  const json summary = with({"-o", "with.csv", "--scene", "a.scene.toml"});
  EXPECT_FALSE(bare.contains("azimuths_of_objects"));
  EXPECT_EQ(bare["features_hidden"], 0);
  // From 20 km up it is all below the skyline, so it hides nothing but ground.
  EXPECT_EQ(summary["azimuths_of_objects"], 0);
  EXPECT_EQ(read_text(dir_ / "with.csv").substr(0, read_text(dir_ / "with.csv").find('\n')),
            "azimuth_deg,elevation_deg,range_m,lon_deg,lat_deg,elevation_m,object");
  const json low = ask({"--height", "300", "--from", "-10", "--to", "10", "--step", "0.5", "-o", "low.csv",
                        "--scene", "a.scene.toml", "--names", "names.csv"});
  const json low_bare =
      ask({"--height", "300", "--from", "-10", "--to", "10", "--step", "0.5", "-o", "low_bare.csv"});
  // Its near side is 3 km wide, 18.5 km away: 4.64 degrees to each side. Its top is some 8 degrees high.
  EXPECT_EQ(low["azimuths_of_objects"], 19);
  EXPECT_NEAR(low["highest"]["elevation_deg"].get<double>(), 8, 2.5);
  EXPECT_NEAR(low["highest"]["range_m"].get<double>(), 18'700, 700);
  EXPECT_LT(low_bare["highest"]["elevation_deg"].get<double>(), low["highest"]["elevation_deg"].get<double>());
  const std::string rows = read_text(dir_ / "low.csv");
  EXPECT_NE(rows.find(",\"the tower, white\"\n"), std::string::npos);
  for (const json& feature : low["features"]) {
    if (feature["name"] != "Behind") continue;
    EXPECT_EQ(feature["visible"], false);
    EXPECT_EQ(feature["hidden_by"]["name"], "the tower, white");
  }
}

TEST_F(Horizon, ALandscape) {
  ASSERT_EQ(vpe(words({"--height", "2", "--step", "1", "--landscape", "land"})).exit_code, 0);
  EXPECT_NE(read_text(dir_ / "land/landscape.ini").find("polygonal_horizon_list = horizon.txt\n"),
            std::string::npos);
  std::istringstream list(read_text(dir_ / "land/horizon.txt"));
  std::string line;
  std::getline(list, line);
  EXPECT_EQ(line[0], '#');
  int count = 0;
  for (double azimuth = 0, elevation = 0; list >> azimuth >> elevation; ++count) EXPECT_EQ(azimuth, count);
  EXPECT_EQ(count, 360);
}

TEST_F(Horizon, BadInput) {
  const std::string p = planet().string();
  expect_failure({"horizon", p, "--height", "2", "-o", "s.csv"}, 2, {"--at"});
  expect_failure({"horizon", p, "--at", "1/2", "--height", "2", "-o", "s.csv"}, 2, {"--at '1/2'", "LON,LAT"});
  expect_failure({"horizon", p, "--at", "1,91", "--height", "2", "-o", "s.csv"}, 2, {"1,91", "latitude"});
  expect_failure(words({"-o", "s.csv"}), 2, {"--height", "--altitude"});
  expect_failure(words({"-o", "s.csv", "--height", "1", "--altitude", "1"}), 2,
                 {"either --height", "--altitude"});
  expect_failure(words({"-o", "s.csv", "--height", "-3"}), 2, {"--height"});
  EXPECT_EQ(vpe(words({"-o", "low.csv", "--height", "0.001", "--step", "30"})).exit_code, 0);
  expect_failure(words({"-o", "s.csv", "--height", "0"}), 1, {"above the ground", "--height"});
  expect_failure(words({"-o", "s.csv", "--altitude", "-900000"}), 1,
                 {"20,10", "above the ground", "--altitude"});
  expect_failure(words({"--height", "2"}), 2, {"nothing to write", "-o"});
  expect_failure(words({"--height", "2", "-o", "s.csv", "--step", "0"}), 2, {"--step"});
  expect_failure(words({"--height", "2", "-o", "s.csv", "--from", "9", "--to", "9"}), 2,
                 {"--from -20 --to 20"});
  expect_failure(words({"--height", "2", "-o", "no/s.csv"}), 1, {"no/s.csv", "there is no folder"});
  expect_failure(words({"--height", "2", "--landscape", "l", "--to", "90"}), 2, {"--landscape", "full circle"});
  expect_failure(words({"--height", "2", "-o", "s.csv", "--features", "f.csv"}), 2, {"--features", "--names"});
  expect_failure(words({"--height", "2", "-o", "s.csv", "--names", "gone.csv"}), 1, {"gone.csv"});
  write_text(dir_ / "file", "");
  expect_failure(words({"--height", "2", "--landscape", "file"}), 1, {"file", "folder"});
  EXPECT_FALSE(exists("s.csv"));
  EXPECT_FALSE(exists("l"));
}

TEST_F(Horizon, StopsWhenAsked) {
  Command command =
      command_for(words({"--height", "2", "-o", "s.csv", "--landscape", "l", "--step", "0.0001"}));
  command.signal = SIGINT;
  command.when = [this] { return exists("l"); };  // the first thing that is made
  const Result result = run(command);
  EXPECT_TRUE(result.signalled);
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_FALSE(exists("s.csv"));
  EXPECT_TRUE(leftovers().empty());
}

}  // namespace
}  // namespace app_test
