// vpe sun as a user runs it.
#include <cmath>

#include "mars/geodesy/sun_times.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr double kRadius_m = 3396190;

class Sun : public AppTest {
 protected:
  json ask(const std::string& planet, const Words& more) const {
    Words words{"sun", planet, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  }
};

TEST_F(Sun, TheVectorOfGiss) {
  // 2004-01-03T13:46:31Z: Ls 327.32416, MTC 13.16537, LMST at 184.702 W 0.85190.
  const json answer = ask(planet().string(), {"--at", "-184.702,0", "--date", "2004-01-03T13:46:31Z"});
  EXPECT_NEAR(answer["solar_longitude_deg"].get<double>(), 327.32416, 0.5001e-5);
  EXPECT_NEAR(answer["mtc_h"].get<double>(), 13.16537, 0.5001e-5);
  EXPECT_NEAR(answer["msd"].get<double>(), 46215.54856, 0.5001e-5);
  EXPECT_NEAR(answer["lmst_h"].get<double>(), 0.85190, 0.5001e-5);
  EXPECT_NEAR(answer["ltst_h"].get<double>(), 0.85190 - 12.77553 / 15, 1e-5);
  EXPECT_TRUE(answer["sun"]["night"]);
  EXPECT_FALSE(answer["sun"]["seen"]);
  EXPECT_TRUE(answer["place"]["datum"].is_string());
  EXPECT_GT(answer["place"]["post_spacing_m"], 0);
}

TEST_F(Sun, RisesOverAWallOfKnownHeightWithinASecond) {
  // A plain that ends 0.5 degrees east of the eye at a wall of 1500 m.
  constexpr double kCell_deg = 0.0005;
  constexpr double kWest_deg = 10;
  constexpr int kFirstHigh = 1200;  // column
  constexpr double kWall_m = 1500;
  Dem dem;
  dem.width = 1800;
  dem.height = 500;
  dem.west_deg = kWest_deg;
  dem.north_deg = 0.2;
  dem.cell_deg = kCell_deg;
  dem.height_m = [](int column, int) { return column >= kFirstHigh ? kWall_m : 0.0; };
  write_dem(dir_ / "wall.tif", dem);
  ASSERT_EQ(vpe({"build", "wall.tif", "-o", "wall.vpe", "--base-spacing", "30000", "-q"}).exit_code, 0);
  const double eye_deg = 10.1;
  constexpr double kEye_m = 2;
  const json answer = ask(path("wall.vpe"), {"--at", "10.1,0", "--height", "2", "--date", "2026-11-27T12:00Z"});
  ASSERT_FALSE(answer["periods"].empty());
  const json& rise = answer["periods"][0]["rise"];
  ASSERT_TRUE(rise.is_object());
  // The sun rises not quite in the east, over a point of the wall farther along it.
  const double azimuth = rise["azimuth_deg"].get<double>() * mars::kRadiansPerDegree;
  const double away_deg = kWest_deg + (kFirstHigh + 0.5) * kCell_deg - eye_deg;
  // On the sphere, from the equator to a meridian: tan(arc) sin(azimuth) = tan(longitude).
  const double arc = std::atan(std::tan(away_deg * mars::kRadiansPerDegree) / std::sin(azimuth));
  const double elevation_deg = std::atan2((kRadius_m + kWall_m) * std::cos(arc) - (kRadius_m + kEye_m),
                                          (kRadius_m + kWall_m) * std::sin(arc)) /
                               mars::kRadiansPerDegree;
  EXPECT_NEAR(rise["skyline"]["range_m"].get<double>(), kRadius_m * arc, 100);
  // The time at which the sun is that high: at the equator sin(elevation) = cos(declination) cos(hour angle).
  const mars::MarsTime time = mars::mars_time(rise["unix_s"].get<double>());
  const double cosine = std::sin(elevation_deg * mars::kRadiansPerDegree) /
                        std::cos(time.subsolar_lat_deg * mars::kRadiansPerDegree);
  const double expected_h = 12 - std::acos(cosine) / mars::kRadiansPerDegree / 15;
  EXPECT_NEAR(rise["ltst_h"].get<double>() * mars::kSol_s / 24, expected_h * mars::kSol_s / 24, 1);
}

TEST_F(Sun, TheTableAgreesWithThePeriods) {
  const json answer =
      ask(planet().string(), {"--at", "20,10", "--date", "2026-11-27", "--height", "2", "--table", "20"});
  ASSERT_EQ(answer["table"].size(), 74U);  // 24 h 39 min 35 s
  for (const json& row : answer["table"]) {
    EXPECT_EQ(row["seen"].get<bool>(), row["elevation_deg"].get<double>() > row["skyline_deg"].get<double>());
  }
  double sum_s = 0;
  for (const json& p : answer["periods"])
    sum_s += p["set"]["unix_s"].get<double>() - p["rise"]["unix_s"].get<double>();
  EXPECT_NEAR(answer["sol"]["seen_s"].get<double>(), sum_s, 1e-3);
}

TEST_F(Sun, PolarDayAndNightAndTheUpperLimb) {
  const Words flat{"--date", "2026-11-27", "--horizon", "flat"};
  const auto with = [&](Words more) {
    more.insert(more.end(), flat.begin(), flat.end());
    return ask(planet().string(), more);
  };
  const json day = with({"--at", "10,85"});
  ASSERT_EQ(day["periods"].size(), 1U);
  EXPECT_TRUE(day["periods"][0]["rise"].is_null());
  EXPECT_TRUE(day["periods"][0]["set"].is_null());
  EXPECT_TRUE(with({"--at", "10,-85"})["periods"].empty());
  const double rise_s = with({"--at", "0,0"})["periods"][0]["rise"]["unix_s"];
  const double early_s = with({"--at", "0,0", "--limb", "upper"})["periods"][0]["rise"]["unix_s"];
  EXPECT_NEAR(rise_s - early_s, 0.1645 / (360 / mars::kSol_s) / std::cos(0.198), 1);
}

TEST_F(Sun, TextForPeople) {
  const Result result =
      vpe({"sun", planet().string(), "--at", "20,10", "--date", "2026-11-27T12:00Z", "--table", "60", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, {"datum", "posts", "error", "LMST", "LTST", "Rise", "Set", "azimuth",
                                "no refraction", "date,lmst,ltst,azimuth_deg"}));
}

TEST_F(Sun, BadInput) {
  const std::string p = planet().string();
  expect_failure({"sun", p, "--at", "1,2"}, 2, {"--date"});
  expect_failure({"sun", p, "--date", "2026-11-27"}, 2, {"--at"});
  expect_failure({"sun", p, "--at", "1,2", "--date", "2026-13-27"}, 2, {"--date", "2026-13-27", "day"});
  expect_failure({"sun", p, "--at", "1,2", "--date", "Ls90,12:00"}, 2, {"expected a date"});
  expect_failure({"sun", p, "--at", "1,200", "--date", "2026-11-27"}, 2, {"--at"});
  expect_failure({"sun", p, "--at", "1,2", "--date", "2026-11-27", "--table", "0"}, 2, {"--table"});
  expect_failure({"sun", p, "--at", "1,2", "--date", "2026-11-27", "--height", "nan"}, 2, {"--height"});
  expect_failure({"sun", p, "--at", "1,2", "--date", "2026-11-27", "--horizon", "sea"}, 2, {"--horizon"});
  expect_failure({"sun", p, "--at", "1,2", "--date", "2026-11-27", "--limb", "lower"}, 2, {"--limb"});
  expect_failure({"sun", path("none.vpe"), "--at", "1,2", "--date", "2026-11-27"}, 1, {"none.vpe"});
}

TEST_F(Sun, OtherBodiesAreRefused) {
  Dem dem;
  dem.radius_m = 1737400;
  write_dem(dir_ / "moon.tif", dem);
  const Result built =
      vpe({"build", "moon.tif", "-o", "moon.vpe", "--body", "Moon", "--base-spacing", "300000", "-q"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  expect_failure({"sun", path("moon.vpe"), "--at", "1,2", "--date", "2026-11-27"}, 2, {"Mars only", "Moon"});
}

}  // namespace
}  // namespace app_test
