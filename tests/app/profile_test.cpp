// vpe profile.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

class Profile : public AppTest {
 protected:
  json ask(const Words& more, const std::string& input = "") const {
    Words words{"profile", planet().string(), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words, input);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out)["points"];
  }
};

TEST_F(Profile, FollowsTheGreatCircle) {
  const json points = ask({"-100,60", "100,60", "--step", "50000"});
  // 160 degrees of longitude at 60 north: the great circle passes near the pole, shorter than the parallel.
  const double arc = 2 * std::asin(std::cos(M_PI / 3) * std::sin(80 * M_PI / 180));
  EXPECT_NEAR(points.back()["distance_m"].get<double>(), 3396190 * arc, 1e-3);
  EXPECT_EQ(points.size(), static_cast<std::size_t>(std::ceil(3396190 * arc / 50000)) + 1);
  double north = 0;
  double last = -1;
  for (const json& p : points) {
    north = std::max(north, p["lat_deg"].get<double>());
    EXPECT_GT(p["distance_m"].get<double>(), last);
    last = p["distance_m"].get<double>();
    EXPECT_GE(p["ground_distance_m"].get<double>(), 0.998 * last);
  }
  EXPECT_GT(north, 83);
  EXPECT_EQ(points.front()["lon_deg"], -100);
  EXPECT_EQ(points.back()["lon_deg"], 100);
}

TEST_F(Profile, TheResamplingErrorIsThatOfItsPoints) {
  const json answer =
      parse_json(vpe({"profile", planet().string(), "--json", "10,-5", "12,-5", "--step", "20000"}).out);
  double largest_m = 0;
  Words words{"query", planet().string(), "--json"};
  for (const json& p : answer["points"])
    words.push_back(std::to_string(p["lon_deg"].get<double>()) + "," +
                    std::to_string(p["lat_deg"].get<double>()));
  for (const json& at : parse_json(vpe(words).out))
    largest_m =
        std::max(largest_m, at["resampling_max_m"].is_null() ? 0.0 : at["resampling_max_m"].get<double>());
  EXPECT_GT(largest_m, 0);
  EXPECT_EQ(answer["resampling_max_m"], largest_m);
  EXPECT_GT(answer["planet_resampling_max_m"].get<double>(), largest_m);
}

TEST_F(Profile, SteepGroundIsMarkedAndDrawn) {
  const json points = ask({"-60,-5", "-40,-5", "--step", "5000", "--limit", "0.5,2"});
  std::set<double> seen;
  for (const json& p : points) {
    const double slope_deg = p["steepest_slope_deg"];
    const json expected = slope_deg > 2 ? json(2.0) : slope_deg > 0.5 ? json(0.5) : json();
    EXPECT_EQ(p["steeper_than_deg"], expected);
    seen.insert(expected.is_null() ? 0.0 : expected.get<double>());
  }
  EXPECT_GE(seen.size(), 2U);
  EXPECT_FALSE(ask({"-60,-5", "-40,-5"})[0].contains("steeper_than_deg"));

  const Result drawn = vpe({"profile", planet().string(), "-60,-5", "-50,0", "-40,-5", "--limit", "0.5,2",
                            "--plot", "way.svg", "-q"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_GT(std::ranges::count(drawn.out, '\n'), 20);
  const std::string svg = read_text(dir_ / "way.svg");
  EXPECT_TRUE(says(svg, {"<svg", "elevation, m", "distance along the path, km", "steeper than 0.5 degrees",
                         "Vertical exaggeration", "Datum"}));
  // The file is replaced by another plot, and by nothing else.
  EXPECT_EQ(vpe({"profile", planet().string(), "-60,-5", "-59,-5", "--plot", "way.svg", "-q"}).exit_code, 0);
  write_text(dir_ / "notes.svg", "mine");
  expect_failure({"profile", planet().string(), "-60,-5", "-59,-5", "--plot", "notes.svg"}, 1, {"notes.svg"});
  expect_failure({"profile", planet().string(), "-60,-5", "-59,-5", "--plot", "way.pdf"}, 2,
                 {"--plot", ".svg"});
  expect_failure({"profile", planet().string(), "-60,-5", "-59,-5", "--plot", "no/way.svg"}, 1, {"no"});
  expect_failure({"profile", planet().string(), "-60,-5", "-59,-5", "--limit", "9,3"}, 2,
                 {"--limit", "rising"});
  expect_failure({"profile", planet().string(), "-60,-5", "-59,-5", "--limit", "1,2,3,4"}, 2,
                 {"--limit", "three"});
}

TEST_F(Profile, HeightsAreThoseOfQuery) {
  const json points = ask({"10,-5", "40,20", "355,3", "--step", "200000"});
  int given = 0;
  for (const json& p : points) {
    std::ostringstream place;
    place.precision(17);
    place << p["lon_deg"].get<double>() << "," << p["lat_deg"].get<double>();
    const json answer = parse_json(vpe({"query", planet().string(), "--json", place.str()}).out)[0];
    EXPECT_NEAR(p["elevation_m"].get<double>(), answer["elevation_m"].get<double>(), 1e-6);
    EXPECT_NEAR(p["steepest_slope_deg"].get<double>(), answer["slope_deg"].get<double>(), 1e-6);
    given += p["place_given"].get<bool>() ? 1 : 0;
  }
  EXPECT_EQ(given, 3);
  EXPECT_EQ(points.back()["lon_deg"], -5);  // normalized
  // Slopes are those between neighbouring points.
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double run = points[i]["distance_m"].get<double>() - points[i - 1]["distance_m"].get<double>();
    const double rise = points[i]["elevation_m"].get<double>() - points[i - 1]["elevation_m"].get<double>();
    EXPECT_NEAR(points[i]["slope_deg"].get<double>(), std::atan2(rise, run) * 180 / M_PI, 0.01);
  }
}

TEST_F(Profile, CsvAndStandardInput) {
  const Result result = vpe({"profile", planet().string()}, "lon,lat\n10,0\n12,0\n");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(
      line,
      "distance_m,ground_distance_m,lon_deg,lat_deg,elevation_m,slope_deg,steepest_slope_deg,place_given");
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 17), "0.000,0.000,10,0,");
}

TEST_F(Profile, NodataIsNull) {
  Dem dem;
  dem.no_data = -9999;
  dem.height_m = [](int column, int) { return column >= 90 && column < 110 ? -9999.0 : 100.0; };
  write_dem(dir_ / "h.tif", dem);
  ASSERT_EQ(vpe({"build", "h.tif", "-o", "h.vpe", "--base-spacing", "100000", "-q"}).exit_code, 0);
  const json points =
      parse_json(vpe({"profile", "h.vpe", "-20,3", "60,3", "--json", "--step", "100000"}).out)["points"];
  EXPECT_FALSE(points.front()["elevation_m"].is_null());
  EXPECT_TRUE(points[points.size() / 2]["elevation_m"].is_null());
  const Result csv = vpe({"profile", "h.vpe", "20,3", "21,3", "--step", "100000"});
  EXPECT_NE(csv.out.find(",,,1\n"), std::string::npos) << csv.out;
}

TEST_F(Profile, BadInput) {
  expect_failure({"profile", planet().string(), "1,2"}, 2, {"two places"});
  expect_failure({"profile", planet().string(), "0,0", "180,0"}, 2, {"opposite sides", "between"});
  expect_failure({"profile", planet().string(), "0,0", "1,91"}, 2, {"1,91", "latitude"});
  expect_failure({"profile", planet().string(), "0,0", "90,0", "--step", "0"}, 2, {"--step"});
  expect_failure({"profile", planet().string(), "0,0", "90,0", "--step", "0.001"}, 2,
                 {"points", "longer step"});
  expect_failure({"profile", "0/0", "1,1", "2,2"}, 1, {"0/0"});
}

}  // namespace
}  // namespace app_test
