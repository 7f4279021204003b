// vpe sight as a user runs it, against what is known in closed form.
#include <cmath>
#include <numbers>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr double kRadius_m = 3396190;
constexpr double kRadians = std::numbers::pi / 180;

class Sight : public AppTest {
 protected:
  // Builds NAME.vpe of a DEM of 400 x 60 posts, 0.002 degrees apart, from 10 E around the equator.
  std::string ground(const std::string& name, std::function<double(int column, int row)> height_m,
                     std::optional<double> no_data = std::nullopt) const {
    Dem dem;
    dem.width = 400;
    dem.height = 60;
    dem.west_deg = 10;
    dem.north_deg = 0.06;
    dem.cell_deg = 0.002;
    dem.no_data = no_data;
    dem.height_m = std::move(height_m);
    write_dem(dir_ / (name + ".tif"), dem);
    const Result built = vpe({"build", name + ".tif", "-o", name + ".vpe", "--base-spacing", "30000", "-q"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return path(name + ".vpe");
  }

  json ask(const std::string& planet, const Words& more) const {
    Words words{"sight", planet, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  }
};

// Returns the arc at which a level sphere hides the ground from a height.
double horizon_deg(double height_m) { return std::acos(kRadius_m / (kRadius_m + height_m)) / kRadians; }

TEST_F(Sight, EndsAtTheHorizonOfASphereWithoutRelief) {
  const std::string planet = ground("level", [](int, int) { return 0.0; });
  constexpr double kEye_m = 50;
  const double arc_deg = horizon_deg(kEye_m);  // 0.31 degrees, 18.4 km
  const auto to = [&](double share) { return std::to_string(10.1 + share * arc_deg) + ",0"; };
  EXPECT_TRUE(ask(planet, {"--from", "10.1,0", "--to", to(0.97), "--from-height", "50"})["visible"]);
  const json beyond = ask(planet, {"--from", "10.1,0", "--to", to(1.2), "--from-height", "50"});
  EXPECT_FALSE(beyond["visible"]);
  EXPECT_TRUE(beyond["obstacle"].is_object());
  // The tangent at the horizon meets the vertical of the second place there; facets lie less than a metre below.
  const double needed_m = kRadius_m / std::cos(0.2 * arc_deg * kRadians) - kRadius_m;
  EXPECT_NEAR(beyond["needed_height_m"].get<double>(), needed_m, 0.05);
  const double more_m = beyond["needed_height_m"].get<double>();
  const std::string above = std::to_string(more_m + 0.01);
  const std::string below = std::to_string(more_m - 0.01);
  EXPECT_TRUE(ask(
      planet, {"--from", "10.1,0", "--to", to(1.2), "--from-height", "50", "--to-height", above})["visible"]);
  EXPECT_FALSE(ask(
      planet, {"--from", "10.1,0", "--to", to(1.2), "--from-height", "50", "--to-height", below})["visible"]);
}

TEST_F(Sight, AWallStandsInTheWay) {
  // Columns 200 to 205, from 10.401 E to 10.411 E, are 300 m high.
  constexpr double kWall_m = 300;
  const std::string planet =
      ground("wall", [](int column, int) { return column >= 200 && column <= 205 ? kWall_m : 0.0; });
  constexpr double kEye_m = 50;
  const json over = ask(planet, {"--from", "10.3,0", "--to", "10.5,0", "--from-height", "50"});
  EXPECT_FALSE(over["visible"]);
  EXPECT_NEAR(over["obstacle"]["lon_deg"].get<double>(), 10.4, 0.0025);
  EXPECT_NEAR(over["obstacle"]["lat_deg"].get<double>(), 0, 1e-9);
  EXPECT_NEAR(over["arc_m"].get<double>(), 0.2 * kRadians * kRadius_m, 1e-3);
  EXPECT_NEAR(over["distance_m"].get<double>(), 0.2 * kRadians * kRadius_m, 0.5);
  // The line falls, so that it is deepest where the wall ends.
  const double arc = 0.111 * kRadians;
  const double whole = 0.2 * kRadians;
  const double line_m =
      std::sin(whole) / (std::sin(whole - arc) / (kRadius_m + kEye_m) * kRadius_m + std::sin(arc));
  EXPECT_NEAR(over["clearance_m"].get<double>(), line_m * kRadius_m - (kRadius_m + kWall_m), 1);
  // Before the wall nothing is in the way.
  const json before = ask(planet, {"--from", "10.3,0", "--to", "10.39,0", "--from-height", "50"});
  EXPECT_TRUE(before["visible"]);
  EXPECT_TRUE(before["obstacle"].is_null());
  EXPECT_EQ(before["needed_height_m"].get<double>(), 0);
}

TEST_F(Sight, IsTheSameBothWays) {
  for (const char* far : {"60,20", "14,3", "178,-5", "-179,80"}) {
    const Words heights{"--from-height", "9000", "--to-height", "9000"};
    Words there{"--from", "10,5", "--to", far};
    Words back{"--from", far, "--to", "10,5"};
    there.insert(there.end(), heights.begin(), heights.end());
    back.insert(back.end(), heights.begin(), heights.end());
    const json a = ask(planet().string(), there);
    const json b = ask(planet().string(), back);
    EXPECT_EQ(a["visible"], b["visible"]) << far;
    EXPECT_NEAR(a["clearance_m"].get<double>(), b["clearance_m"].get<double>(), 1e-5) << far;
  }
}

TEST_F(Sight, CrossesTheAntimeridianAndThePole) {
  const json across = ask(planet().string(), {"--from", "179.5,10", "--to", "-179.5,10"});
  EXPECT_NEAR(across["arc_m"].get<double>(),
              kRadius_m * 2 * std::asin(std::cos(10 * kRadians) * std::sin(0.5 * kRadians)), 1e-3);
  const json pole = ask(planet().string(), {"--from", "0,89.5", "--to", "180,89.5"});
  EXPECT_NEAR(pole["arc_m"].get<double>(), kRadius_m * kRadians, 1e-3);
}

TEST_F(Sight, NamesDatumResolutionErrorAndSource) {
  const json answer = ask(planet().string(), {"--from", "10,5", "--to", "14,3"});
  EXPECT_TRUE(answer["datum"].is_string());
  EXPECT_EQ(answer["radius_m"].get<double>(), kRadius_m);
  EXPECT_GT(answer["post_spacing_m"].get<double>(), 0);
  EXPECT_GE(answer["coarsest_post_spacing_m"], answer["post_spacing_m"]);
  EXPECT_GT(answer["clearance_error_m"].get<double>(), 0);
  EXPECT_LT(answer["clearance_error_m"].get<double>(), 1e-5);
  EXPECT_EQ(answer["sources"].size(), 1U);
  EXPECT_EQ(answer["nodata_share"].get<double>(), 0);
  EXPECT_EQ(answer["synthetic_share"].get<double>(), 0);
}

TEST_F(Sight, TellsTheShareWithoutData) {
  // Nothing between 10.3 E and 10.5 E, a third of the line.
  const std::string planet = ground(
      "gap", [](int column, int) { return column >= 150 && column < 250 ? -9999.0 : 0.0; }, -9999.0);
  const json answer = ask(planet, {"--from", "10.1,0", "--to", "10.7,0"});
  EXPECT_NEAR(answer["nodata_share"].get<double>(), 1.0 / 3, 0.02);
}

TEST_F(Sight, PrintsTextForPeople) {
  const Result result = vpe({"sight", planet().string(), "--from", "10,5", "--to", "60,20", "-q"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(says(result.out, {"visible:", "no", "obstacle:", "needed height:", "datum:", "resolution:",
                                "error:", "source:", "nodata:", "synthetic:"}));
}

TEST_F(Sight, RefusesBadInput) {
  const std::string p = planet().string();
  expect_failure({"sight", p, "--from", "10,5"}, 2, {"--to"});
  expect_failure({"sight", p, "--to", "10,5"}, 2, {"--from"});
  expect_failure({"sight", p, "--from", "10,95", "--to", "10,5"}, 2, {"--from"});
  expect_failure({"sight", p, "--from", "10,5", "--to", "here"}, 2, {"--to"});
  expect_failure({"sight", p, "--from", "10,5", "--to", "11,5", "--from-height", "-1"}, 2, {"--from-height"});
  expect_failure({"sight", p, "--from", "10,5", "--to", "11,5", "--to-height", "nan"}, 2, {"--to-height"});
  expect_failure({"sight", p, "--from", "10,5", "--to", "-170,-5"}, 2, {"vpe sight", "opposite"});
  expect_failure({"sight", "none.vpe", "--from", "10,5", "--to", "11,5"}, 1, {"none.vpe"});
}

}  // namespace
}  // namespace app_test
