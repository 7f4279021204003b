// vpe route as a user runs it: level ground, a crater's wall, gaps, bad input.
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr double kRouteMetresPerDegree = 3396190 * std::numbers::pi / 180;

class RouteCommand : public AppTest {
 protected:
  static void SetUpTestSuite() { planets_ = std::make_unique<test_support::TempDir>(); }
  static void TearDownTestSuite() { planets_.reset(); }

  // Returns a planet with a DEM of 100 x 100 posts, 0.004 degrees apart, around 10 E on the equator. Made once
  // for each name.
  std::string ground(const std::string& name, std::function<double(double x_deg, double y_deg)> height_m,
                     std::optional<double> no_data = std::nullopt) const {
    const std::string file = (*planets_ / (name + ".vpe")).string();
    if (std::filesystem::exists(file)) return file;
    Dem dem;
    dem.width = 100;
    dem.height = 100;
    dem.west_deg = 9.8;
    dem.north_deg = 0.2;
    dem.cell_deg = 0.004;
    dem.no_data = no_data;
    dem.height_m = [height_m = std::move(height_m)](int column, int row) {
      return height_m((column - 49.5) * 0.004, (49.5 - row) * 0.004);
    };
    write_dem(dir_ / (name + ".tif"), dem);
    const Result built = vpe({"build", name + ".tif", "-o", file, "--base-spacing", "60000", "-q"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return file;
  }

  json route(const std::string& planet, const Words& more) const {
    Words words{"route", planet, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }

  static inline std::unique_ptr<test_support::TempDir> planets_;
};

// 500 m high, steep on both sides, 0.02 degrees wide.
double wall_m(double off_deg) { return std::abs(off_deg) < 0.01 ? 500 : 0; }

TEST_F(RouteCommand, OnLevelGroundIsTheGreatCircle) {
  const std::string planet = ground("level", [](double, double) { return 0; });
  const json way =
      route(planet, {"--from", "9.9,-0.1", "--to", "10.1,0.12", "--max-slope", "5", "-o", path("w.geojson")});
  const double straight_m = std::hypot(0.2, 0.22) * kRouteMetresPerDegree;
  EXPECT_NEAR(way["map_length_m"].get<double>(), straight_m, 300);
  EXPECT_NEAR(way["length_m"].get<double>(), way["map_length_m"].get<double>(), 1);
  EXPECT_LE(way["corners"].size(), 3U);
  EXPECT_LT(way["places_off_m"].get<double>(), 200);
  EXPECT_NEAR(way["corners"][0][0].get<double>(), 9.9, 1e-9);
  EXPECT_NEAR(way["corners"][0][1].get<double>(), -0.1, 1e-9);
  const json file = parse_json(read_text(dir_ / "w.geojson"));
  EXPECT_EQ(file["features"].size(), 1U);
  EXPECT_EQ(file["features"][0]["properties"]["length_m"], way["length_m"]);
  EXPECT_TRUE(says(file["description"], {"vpe route", "5 degrees", "Heights count from", "Nodata"}));
}

TEST_F(RouteCommand, GoesThroughTheGapOfAWall) {
  const std::string planet =
      ground("wall", [](double x, double y) { return y > 0.1 && y < 0.14 ? 0 : wall_m(x); });
  const json way = route(planet, {"--from", "9.9,0", "--to", "10.1,0", "--max-slope", "15", "--margin", "10500",
                                  "-o", path("w.gpkg")});
  const double by_gap_m = 2 * std::hypot(0.1, 0.1) * kRouteMetresPerDegree;
  EXPECT_GT(way["length_m"].get<double>(), by_gap_m);
  EXPECT_LT(way["length_m"].get<double>(), 1.15 * by_gap_m);
  EXPECT_LE(way["steepest_deg"].get<double>(), 15.001);
  EXPECT_LE(way["steepest_ground_deg"].get<double>(), 15.001);
  for (const json& corner : way["corners"])
    if (std::abs(corner[0].get<double>() - 10) < 0.004) {
      EXPECT_GT(corner[1].get<double>(), 0.1);
    }
  // Within a margin that does not hold the gap there is no way.
  expect_failure({"route", planet, "--from", "9.9,0", "--to", "10.1,0", "--max-slope", "15", "--margin", "2000",
                  "-o", path("n.gpkg"), "-q"},
                 1, {"no way", "--from", "--to", "15 degrees", "square kilometres", "--margin"});
  EXPECT_FALSE(exists("n.gpkg"));
}

TEST_F(RouteCommand, PassesPlacesInOrder) {
  const std::string planet = ground("level", [](double, double) { return 0; });
  const json way = route(planet, {"--from", "9.9,0", "--via", "10,0.1", "--via", "10.05,-0.05", "--to",
                                  "10.1,0", "--max-slope", "5", "-o", path("w.geojson")});
  const double length_m =
      (std::hypot(0.1, 0.1) + std::hypot(0.05, 0.15) + std::hypot(0.05, 0.05)) * kRouteMetresPerDegree;
  EXPECT_NEAR(way["length_m"].get<double>(), length_m, 800);
}

TEST_F(RouteCommand, TellsWhyThereIsNoWay) {
  const std::string planet = ground(
      "parts",
      [](double x, double y) {
        return std::abs(x - 0.05) < 0.012 ? -9999.0 : 400 * std::exp(-(x * x + y * y) * 1e4);
      },
      -9999.0);
  const auto words = [&](const char* from, const char* to) {
    return Words{"route", planet, "--from",          from, "--to", to, "--max-slope",
                 "10",    "-o",   path("n.geojson"), "-q"};
  };
  expect_failure(words("10.005,0", "9.9,0"), 1, {"--from", "degrees steep", "10 degrees", "--max-slope"});
  expect_failure(words("9.9,0", "10.05,0"), 1, {"--to", "nodata"});
  expect_failure(words("9.9,0", "10.1,0"), 1, {"no way from --from", "--to", "square kilometres"});
}

TEST_F(RouteCommand, PrintsTextForPeople) {
  const std::string planet = ground("level", [](double, double) { return 0; });
  const Result result = vpe({"route", planet, "--from", "9.9,0", "--to", "10.1,0", "--max-slope", "5", "-o",
                             path("w.geojson"), "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, {"way:", "length:", "climb:", "slope:", "cost:", "places:", "grid:", "datum:",
                                "resolution:", "error:", "source:", "nodata:", "synthetic:"}));
}

TEST_F(RouteCommand, RefusesBadInput) {
  const std::string p = planet().string();
  const std::string out = path("x.geojson");
  const auto words = [&](Words more) {
    Words all{"route", p, "--from", "10,5", "--to", "11,5", "--max-slope", "20", "-o", out};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_failure({"route", p, "--to", "11,5", "--max-slope", "20", "-o", out}, 2, {"--from"});
  expect_failure({"route", p, "--from", "10,5", "--max-slope", "20", "-o", out}, 2, {"--to"});
  expect_failure({"route", p, "--from", "10,5", "--to", "11,5", "-o", out}, 2, {"--max-slope"});
  expect_failure({"route", p, "--from", "10,5", "--to", "11,5", "--max-slope", "20"}, 2, {"-o"});
  expect_failure({"route", p, "--from", "10,95", "--to", "11,5", "--max-slope", "20", "-o", out}, 2,
                 {"--from"});
  expect_failure({"route", p, "--from", "10,5", "--to", "there", "--max-slope", "20", "-o", out}, 2, {"--to"});
  expect_failure({"route", p, "--from", "10,5", "--to", "11,5", "--max-slope", "90", "-o", out}, 2,
                 {"--max-slope"});
  expect_failure(words({"--via", "here"}), 2, {"--via"});
  expect_failure(words({"--max-cross-slope", "nan"}), 2, {"--max-cross-slope"});
  expect_failure(words({"--slope-weight", "-1"}), 2, {"--slope-weight"});
  expect_failure(words({"--margin", "-1"}), 2, {"--margin"});
  expect_failure(words({"--spacing", "1"}), 2, {"million", "--spacing", "--margin"});
  expect_failure({"route", "none.vpe", "--from", "10,5", "--to", "11,5", "--max-slope", "20", "-o", out}, 1,
                 {"none.vpe"});
  EXPECT_FALSE(exists("x.geojson"));
}

}  // namespace
}  // namespace app_test
