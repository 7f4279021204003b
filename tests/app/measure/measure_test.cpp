// vpe measure as a user runs it.
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

class Measure : public AppTest {
 protected:
  // A plain that falls by 2 m in 100 to the east, and has a round pit of 60 m with level ground; a part of it has no data.
  static constexpr double kCell_deg = 0.001;
  static constexpr double kRadius_m = 3396190;
  static constexpr double kPit_deg = 0.1;
  void SetUp() override {
    AppTest::SetUp();
    Dem dem;
    dem.width = 1000;
    dem.height = 1000;
    dem.west_deg = 9.5;
    dem.north_deg = 0.5;
    dem.cell_deg = kCell_deg;
    dem.height_m = [](int column, int row) {
      const double x = (column + 0.5) * kCell_deg - 0.5;
      const double y = 0.5 - (row + 0.5) * kCell_deg;
      return -1000 - 0.02 * x * kRadius_m * mars::kRadiansPerDegree -
             (std::hypot(x, y) < kPit_deg ? 60.0 : 0.0);
    };
    write_dem(dir_ / "slope.tif", dem);
    const Result built = vpe({"build", "slope.tif", "-o", "slope.vpe", "--base-spacing", "30000", "-q"});
    ASSERT_EQ(built.exit_code, 0) << built.err;
  }
  nlohmann::json measured(const Words& more) const {
    Words words{"measure", path("slope.vpe"), "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  }
};

const Words kPlain{"10.2,-0.3", "10.4,-0.3", "10.4,0.3", "10.2,0.3"};
const Words kAroundPit{"9.8,-0.2", "10.2,-0.2", "10.2,0.2", "9.8,0.2"};

TEST_F(Measure, APlainHasItsDipAndNoVolume) {
  const auto list = measured(kPlain);
  ASSERT_EQ(list.size(), 1U);
  const auto& one = list[0];
  const double side_m = kRadius_m * mars::kRadiansPerDegree;
  EXPECT_NEAR(one["sphere_area_m2"].get<double>(), 0.2 * 0.6 * side_m * side_m, 1e-4 * side_m * side_m);
  EXPECT_NEAR(one["outline_m"].get<double>(), 1.6 * side_m, 1e-3 * side_m);
  // The ground is a kilometre lower than the sphere, and tilted.
  const double lower = 1 + one["mean_m"].get<double>() / kRadius_m;
  EXPECT_NEAR(one["ground_area_m2"].get<double>(),
              one["sphere_area_m2"].get<double>() * lower * lower / std::cos(std::atan(0.02)),
              1e-4 * one["sphere_area_m2"].get<double>());
  const auto& plane = one["plane"];
  EXPECT_NEAR(plane["dip_deg"].get<double>(), std::atan(0.02) / mars::kRadiansPerDegree, 0.01);
  EXPECT_NEAR(plane["dip_azimuth_deg"].get<double>(), 90, 1);
  EXPECT_NEAR(std::remainder(plane["strike_deg"].get<double>(), 360), 0, 1);
  EXPECT_LT(plane["dip_error_deg"].get<double>(), 0.1);
  EXPECT_EQ(one["nodata_share"], 0);
  EXPECT_EQ(one["synthetic_share"], 0);
  EXPECT_EQ(one["is_exact"], true);
  EXPECT_TRUE(one["over_level"].is_null());
  EXPECT_EQ(one["radius_m"], kRadius_m);
  EXPECT_TRUE(one["datum"].is_string());
  EXPECT_GT(one["elevation_error_m"], 0);
}

TEST_F(Measure, APitHasItsVolumeBelowTheRim) {
  const double pit_m2 = mars::kPi * std::pow(kPit_deg * kRadius_m * mars::kRadiansPerDegree, 2);
  const auto one = measured({kAroundPit[0], kAroundPit[1], kAroundPit[2], kAroundPit[3], "--limit", "10,89",
                             "--water-level", "-1100"})[0];
  EXPECT_NEAR(one["over_rim"]["below_m3"].get<double>(), 60 * pit_m2, 0.02 * 60 * pit_m2);
  EXPECT_LT(one["over_rim"]["above_m3"].get<double>(), 0.02 * 60 * pit_m2);
  EXPECT_GT(one["over_rim"]["error_m3"].get<double>(), 0);
  EXPECT_GT(one["over_level"]["above_m3"].get<double>(), 0);
  EXPECT_EQ(one["level_m"], -1100);
  EXPECT_GT(one["slope"]["steeper"][0]["share"], 0);
  EXPECT_EQ(one["slope"]["steeper"][1]["share"], 0);
  // The same outline the other way round.
  const auto turned = measured({kAroundPit[3], kAroundPit[2], kAroundPit[1], kAroundPit[0]})[0];
  EXPECT_NEAR(turned["over_rim"]["below_m3"].get<double>(), one["over_rim"]["below_m3"].get<double>(), 1);
}

TEST_F(Measure, VolumesAgainstAnotherPlanetAreWhatWasDug) {
  Dem dem;
  dem.width = 1000;
  dem.height = 1000;
  dem.west_deg = 9.5;
  dem.north_deg = 0.5;
  dem.cell_deg = kCell_deg;
  dem.height_m = [](int column, int) {
    return -1000 - 0.02 * ((column + 0.5) * kCell_deg - 0.5) * kRadius_m * mars::kRadiansPerDegree;
  };
  write_dem(dir_ / "before.tif", dem);
  const Result built = vpe({"build", "before.tif", "-o", "before.vpe", "--base-spacing", "30000", "-q"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  Words words = kAroundPit;
  words.insert(words.end(), {"--against", "before.vpe"});
  const auto one = measured(words)[0];
  const double reach_m = kPit_deg * kRadius_m * mars::kRadiansPerDegree;
  const double pit_m3 = 60 * mars::kPi * reach_m * reach_m;
  EXPECT_NEAR(one["over_other"]["below_m3"].get<double>(), pit_m3, 0.01 * pit_m3);
  EXPECT_LT(one["over_other"]["above_m3"].get<double>(), 0.001 * pit_m3);
  EXPECT_EQ(one["other"], "before.vpe");
  EXPECT_TRUE(measured(kAroundPit)[0]["over_other"].is_null());
  words.back() = "missing.vpe";
  words.insert(words.begin(), {"measure", path("slope.vpe"), "-q"});
  const Result refused = vpe(words);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(says(refused.err, {"missing.vpe"})) << refused.err;
}

TEST_F(Measure, PolygonsOfAFileAreMeasuredOneByOne) {
  write_text(dir_ / "units.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": "Plain"}, "geometry": {"type": "Polygon", "coordinates":
      [[[10.2, -0.3], [10.4, -0.3], [10.4, 0.3], [10.2, 0.3], [10.2, -0.3]]]}},
    {"type": "Feature", "properties": {"name": "A point"}, "geometry": {"type": "Point", "coordinates": [10, 0]}},
    {"type": "Feature", "properties": {"name": "Pit"}, "geometry": {"type": "Polygon", "coordinates":
      [[[9.8, -0.2], [10.2, -0.2], [10.2, 0.2], [9.8, 0.2], [9.8, -0.2]]]}}]})");
  const auto list = measured({"--polygons", "units.geojson"});
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]["name"], "Plain");
  EXPECT_EQ(list[1]["name"], "Pit");
  EXPECT_EQ(list[0]["ground_area_m2"], measured(kPlain)[0]["ground_area_m2"]);
  const Result words =
      vpe({"measure", path("slope.vpe"), "--polygons", "units.geojson", "-q", "--water-level", "-1000"});
  EXPECT_EQ(words.exit_code, 0) << words.err;
  EXPECT_TRUE(says(words.out, {"Plain", "Pit", "dip", "strike", "volume against the rim", "level of -1000 m",
                               "datum", "nodata", "synthetic"}))
      << words.out;
}

TEST_F(Measure, GroundWithoutDataIsCounted) {
  const Result result =
      vpe({"measure", path("slope.vpe"), "10.4,-0.1", "10.6,-0.1", "10.6,0.1", "10.4,0.1", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(parse_json(result.out)[0]["nodata_share"].get<double>(), 0.5, 0.2);
}

TEST_F(Measure, BadInputIsReported) {
  const auto refuse = [&](int code, Words words, const Words& parts) {
    words.insert(words.begin(), {"measure", path("slope.vpe")});
    expect_failure(words, code, parts);
  };
  refuse(2, {"10,0", "11,0"}, {"three places"});
  refuse(2, {"10,0", "11,0", "11,95"}, {"95"});
  refuse(1, {"10,-0.2", "10.2,0.2", "10.2,-0.2", "10,0.2"}, {"cross"});
  refuse(1, {"0,0", "170,0", "90,80"}, {"too large"});
  refuse(2, {"10,0", "11,0", "11,1", "--limit", "120"}, {"--limit", "120"});
  refuse(2, {"10,0", "11,0", "11,1", "--polygons", "x.geojson"}, {"--polygons", "leave out"});
  refuse(1, {"--polygons", "none.geojson"}, {"none.geojson"});
  write_text(dir_ / "bad.geojson", "{\"type\": \"Polygon\", \"coordinates\": [[[0");
  refuse(1, {"--polygons", "bad.geojson"}, {"bad.geojson"});
  write_text(dir_ / "point.geojson", R"({"type": "Point", "coordinates": [10, 0]})");
  refuse(1, {"--polygons", "point.geojson"}, {"point.geojson", "no polygon"});
}

}  // namespace
}  // namespace app_test
