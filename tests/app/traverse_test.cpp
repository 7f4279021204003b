// vpe traverse.
#include <cmath>
#include <regex>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

const std::string kKml =
    "<kml xmlns:gx=\"x\"><Document><Placemark><LineString><coordinates>10,-5 10.01,-5 10.01,-4.99</coordinates>"
    "</LineString></Placemark></Document></kml>";

class Traverse : public AppTest {
 protected:
  void SetUp() override {
    write_text(path("way.csv"), "name,lat,lon\na,-5,10\n\"b, c\",-5,10.01\n# comment\nd,-4.99,10.01\n");
    write_text(path("way.kml"), kKml);
  }
  Words words(const std::string& file, const Words& more = {}) const {
    Words all{"traverse", file, planet().string(), "-o", "out.flight"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string flight(const std::string& file, const Words& more = {}) const {
    const Result result = vpe(words(file, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    return read_text(path("out.flight"));
  }
};

// The poses without the comment that names the file.
std::string poses(const std::string& text) {
  return std::regex_replace(text, std::regex("# traverse[^\n]*\n"), "");
}

TEST_F(Traverse, ATableAndAKmlFileOfOneWayGiveOneFlight) {
  const std::string table = flight("way.csv");
  EXPECT_TRUE(table.starts_with("flight 1\n# traverse of vpe: way.csv, by walk\n")) << table.substr(0, 80);
  EXPECT_EQ(poses(flight("way.kml")), poses(table));
  const Result piped =
      vpe({"traverse", "-", planet().string(), "-o", "piped.flight", "-q"}, read_text(path("way.csv")));
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(piped.err, "");
  EXPECT_EQ(poses(read_text(path("piped.flight"))), poses(table));
}

TEST_F(Traverse, TheSummaryIsThatOfTheFlight) {
  const Result result = vpe(words("way.kml", {"--by", "drive", "--speed", "4", "--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json answer = parse_json(result.out);
  const double degree_m = 3396190 * M_PI / 180;
  EXPECT_NEAR(answer["length_m"].get<double>(), 0.01 * degree_m * (std::cos(5 * M_PI / 180) + 1), 0.1);
  EXPECT_NEAR(answer["duration_s"].get<double>(), answer["length_m"].get<double>() / 4, 1e-6);
  const std::string text = read_text(path("out.flight"));
  std::size_t lines = 0;
  for (std::size_t at = text.find(" pose "); at != std::string::npos; at = text.find(" pose ", at + 1)) ++lines;
  EXPECT_EQ(answer["poses"].get<std::size_t>(), lines);
  EXPECT_EQ(answer["slope_limit_deg"], 30);
  EXPECT_GE(answer["steepest_deg"].get<double>(), 0);
}

TEST_F(Traverse, TheFlightIsFilmed) {
  (void)flight("way.kml", {"--by", "drive", "--step", "50", "--speed", "2000"});
  const Result film = vpe({"fly", "out.flight", planet().string(), "-o", "frames", "--size", "64x36"});
  EXPECT_EQ(film.exit_code, 0) << film.err;
  EXPECT_TRUE(exists("frames"));
}

TEST_F(Traverse, ATourKeepsItsViews) {
  write_text(
      path("tour.kml"),
      "<kml><gx:Tour><gx:FlyTo><Camera><longitude>10</longitude><latitude>-5</latitude><altitude>900</altitude>"
      "<tilt>70</tilt><altitudeMode>relativeToGround</altitudeMode></Camera></gx:FlyTo><gx:FlyTo>"
      "<gx:duration>6</gx:duration><LookAt><longitude>11</longitude><latitude>-5</latitude><tilt>45</tilt>"
      "<range>9000</range></LookAt></gx:FlyTo></gx:Tour></kml>");
  const std::string text = flight("tour.kml", {"--by", "height"});
  EXPECT_NE(text.find("at 0 pose lon=10 lat=-5 "), std::string::npos) << text;
  EXPECT_NE(text.find("at 6 pose "), std::string::npos) << text;
  EXPECT_NE(text.find("pitch=-20"), std::string::npos) << text;
  EXPECT_NE(flight("tour.kml", {"--by", "walk"}).find("height=1.7"), std::string::npos);
}

TEST_F(Traverse, ALineOfAVectorFileIsTheWayOfATable) {
  write_text(path("line.geojson"),
             R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry":
                {"type": "LineString", "coordinates": [[10, -5], [10.01, -5], [10.01, -4.99]]}}]})");
  EXPECT_EQ(poses(flight("line.geojson")), poses(flight("way.csv")));
}

TEST_F(Traverse, ATrackHasItsTimes) {
  write_text(path("track.gpx"),
             "<gpx version='1.1' creator='t' xmlns='http://www.topografix.com/GPX/1/1'><trk><trkseg>"
             "<trkpt lat='-5' lon='10'><time>2026-11-27T12:00:00Z</time></trkpt>"
             "<trkpt lat='-5' lon='10.01'><time>2026-11-27T12:05:00Z</time></trkpt></trkseg><trkseg>"
             "<trkpt lat='-4.99' lon='10.01'><time>2026-11-27T12:20:00Z</time></trkpt></trkseg></trk></gpx>");
  const auto duration_s = [&](const Words& more) {
    Words all = words("track.gpx", more);
    all.emplace_back("--json");
    const Result result = vpe(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out)["duration_s"].get<double>();
  };
  EXPECT_NEAR(duration_s({"--by", "drive"}), 1200, 1e-6);
  EXPECT_NEAR(duration_s({"--by", "walk", "--time-scale", "10"}), 120, 1e-6);
  EXPECT_NEAR(duration_s({"--by", "height", "--speed", "100"}), 2 * 0.01 * 3396190 * M_PI / 180 / 100, 0.1);
  const std::string text = flight("track.gpx", {"--by", "height", "--step", "1000"});
  EXPECT_NE(text.find("at 300 pose lon=10.01 lat=-5 "), std::string::npos) << text;
  EXPECT_EQ(vpe({"fly", "out.flight", planet().string(), "-o", "frames", "--size", "64x36", "--frames", "0-2"})
                .exit_code,
            0);
  // A segment alone has one point.
  expect_failure(words("track.gpx", {"--way", "2"}), 2, {"track.gpx", "two different places"});
  expect_failure(words("track.gpx", {"--way", "3"}), 2, {"--way 3", "2 ways"});
}

TEST_F(Traverse, PointsHaveTheAttitudeOfTheirFields) {
  const auto station = [](const char* lon, const char* yaw) {
    return std::string(R"({"type": "Feature", "properties": {"heading": )") + yaw +
           R"(, "pitch": -20}, "geometry": {"type": "Point", "coordinates": [)" + lon + ", -5]}}";
  };
  write_text(path("stations.geojson"), R"({"type": "FeatureCollection", "features": [)" + station("10", "5") +
                                           ", " + station("10.01", "15") + "]}");
  const std::string text = flight("stations.geojson", {"--by", "height"});
  EXPECT_NE(text.find("yaw=5 pitch=-20"), std::string::npos) << text.substr(0, 400);
  EXPECT_NE(text.find("yaw=15 pitch=-20"), std::string::npos);
}

TEST_F(Traverse, BadVectorFilesAndTheirOptions) {
  write_text(path("empty.geojson"), R"({"type": "FeatureCollection", "features": []})");
  expect_failure(words("empty.geojson"), 1, {"empty.geojson", "lines or points"});
  write_text(path("bad.gpx"), "<gpx");
  expect_failure(words("bad.gpx"), 1, {"bad.gpx"});
  expect_failure(words("missing.gpkg"), 1, {"missing.gpkg"});
  write_text(path("line.geojson"),
             R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry":
                {"type": "LineString", "coordinates": [[10, -5], [10.01, -5]]}}]})");
  expect_failure(words("line.geojson", {"--latitude", "planetographic"}), 2, {"--latitude", "line.geojson"});
  expect_failure(words("line.geojson", {"--layer", "none"}), 1, {"none"});
  expect_failure(words("line.geojson", {"--time-scale", "2"}), 2, {"--time-scale", "no times"});
  expect_failure(words("line.geojson", {"--time-scale", "2", "--speed", "2"}), 2, {"--time-scale", "--speed"});
  expect_failure(words("line.geojson", {"--time-scale", "0"}), 2, {"--time-scale"});
  expect_failure(words("way.csv", {"--layer", "x"}), 2, {"--layer"});
  EXPECT_FALSE(exists("out.flight"));
}

TEST_F(Traverse, SlopesBeyondTheLimitAreWarnedOfOrFail) {
  // Ridges 118 km apart rise by 16 km, that is by 7 degrees.
  Dem ridges;
  ridges.height_m = [](int column, int) { return column % 2 == 0 ? 8000.0 : -8000.0; };
  write_dem(dir_ / "ridges.tif", ridges);
  const Result built = vpe({"build", "ridges.tif", "-o", "ridges.vpe", "--base-spacing", "40000"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  Words words{"traverse", "way.kml", "ridges.vpe", "-o", "out.flight", "--by", "drive", "--step", "50"};
  const Result quiet = vpe(words);
  EXPECT_EQ(quiet.exit_code, 0) << quiet.err;
  EXPECT_EQ(quiet.err.find("beyond"), std::string::npos) << quiet.err;
  words.insert(words.end(), {"--slope-limit", "2"});
  const Result warned = vpe(words);
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_TRUE(says(warned.err, {"warning", "poses are on slopes beyond 2 degrees"}));
  words.emplace_back("--fail-on-slope");
  const Result failed = vpe(words);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_TRUE(says(failed.err, {"beyond 2 degrees"}));
  EXPECT_TRUE(exists("out.flight"));
}

TEST_F(Traverse, BadInputOfEveryKind) {
  expect_failure(words("missing.kml"), 1, {"missing.kml"});
  expect_failure(words("missing.csv"), 1, {"missing.csv"});
  write_text(path("bad.csv"), "lon,lat\n1,2\n3,north\n");
  expect_failure(words("bad.csv"), 2, {"bad.csv, line 3", "north"});
  write_text(path("one.csv"), "lon,lat\n1,2\n");
  expect_failure(words("one.csv"), 2, {"one.csv", "two different places"});
  write_text(path("empty.csv"), "");
  expect_failure(words("empty.csv"), 2, {"empty.csv", "two different places"});
  write_text(path("bad.kml"), "<kml><LineString><coordinates>1,2 3,400</coordinates></LineString></kml>");
  expect_failure(words("bad.kml"), 1, {"bad.kml", "point 2", "latitude"});
  write_text(path("text.kml"), "lon,lat\n1,2\n");
  expect_failure(words("text.kml"), 1, {"text.kml", "not a KML file"});
  write_text(path("zip.kmz"), "PK\x03\x04...");
  expect_failure(words("zip.kmz"), 1, {"zip.kmz", "KMZ"});
  write_text(
      path("two.kml"),
      "<kml><LineString><coordinates>1,2 3,4</coordinates></LineString><gx:Track><gx:coord>1 2 3</gx:coord>"
      "</gx:Track></kml>");
  expect_failure(words("two.kml"), 2, {"--way", "1: LineString of 2 points", "2: gx:Track of 1 points"});
  expect_failure(words("two.kml", {"--way", "3"}), 2, {"--way 3", "2 ways"});
  expect_failure(words("way.csv", {"--way", "1"}), 2, {"--way", "KML"});
  expect_failure(words("way.csv", {"--by", "swim"}), 2, {"--by"});
  expect_failure(words("way.csv", {"--speed", "0"}), 2, {"--speed"});
  expect_failure(words("way.csv", {"--eye", "x"}), 2, {"--eye"});
  expect_failure(words("way.csv", {"--step", "0.1", "--speed", "0.001"}), 2, {"higher speed"});
  expect_failure({"traverse", "way.csv", planet().string()}, 2, {"--output"});
  expect_failure({"traverse", "way.csv", "no.vpe", "-o", "out.flight"}, 1, {"no.vpe"});
  EXPECT_FALSE(exists("out.flight"));
}

TEST_F(Traverse, NeverReplacesAFileOfAnotherKind) {
  write_text(path("tour.flight"), "flight 1\nat 0 pose lon=0 lat=0 alt=1000\n");
  const Result refused = vpe({"traverse", "way.csv", planet().string(), "-o", "tour.flight"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(says(refused.err, {"tour.flight"}));
  EXPECT_EQ(vpe({"traverse", "way.csv", planet().string(), "-o", "way.csv"}).exit_code, 2);
  (void)flight("way.csv");
  (void)flight("way.kml");  // its own is replaced
}

}  // namespace
}  // namespace app_test
