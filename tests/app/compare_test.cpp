// vpe compare: a planet and its patch by reliefs of known volumes.
#include <cmath>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

// Of a crater without a rim, and of a pad with its falloff.
constexpr double kCrater_m = 10000;
constexpr double kDepth_m = 200;
constexpr double kPad_m = 8000;
constexpr double kFalloff_m = 4000;
constexpr double kRise_m = 100;
constexpr double kCrater_m3 = M_PI * kCrater_m * kCrater_m * kDepth_m / 2;
// The integral of a smooth step over the ring of the falloff.
constexpr double kPad_m3 =
    kRise_m * M_PI * (kPad_m * kPad_m + kPad_m * kFalloff_m + 0.3 * kFalloff_m * kFalloff_m);

class Compare : public AppTest {
 protected:
  void SetUp() override {
    Dem globe;
    globe.height_m = [](int, int) { return 0.0; };
    write_dem(dir_ / "globe.tif", globe);
    // Fine tiles where the reliefs will be, so that both planets have the same facets there.
    Dem inset = globe;
    inset.width = inset.height = 160;
    inset.west_deg = 20;
    inset.north_deg = 10;
    inset.cell_deg = 0.01;
    write_dem(dir_ / "inset.tif", inset);
    write_text(dir_ / "works.relief.toml",
               "version = 1\n[[relief]]\nkind = \"crater\"\nlon = 20.4\nlat = 9.2\nradius_m = 10000\n"
               "depth_m = 200\nrim_m = 0\nfloor_ratio = 0\npeak_m = 0\nspacing_m = 600\n"
               "[[relief]]\nkind = \"pad\"\nlon = 21.2\nlat = 9.2\nradius_m = 8000\nfalloff_m = 4000\n"
               "rise_m = 100\nspacing_m = 600\n");
    succeed({"build", "globe.tif", "inset.tif", "-o", "a.vpe", "--base-spacing", "21000", "--datum", "areoid"});
    succeed({"patch", "a.vpe", "works.relief.toml", "-o", "b.vpe"});
  }

  void succeed(Words words) const {
    words.emplace_back("-q");
    const Result result = vpe(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }

  json compare(Words words) const {
    words.insert(words.begin(), "compare");
    words.insert(words.end(), {"--json", "-q"});
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }
};

TEST_F(Compare, APatchHasTheVolumesOfItsReliefs) {
  const json all = compare({"a.vpe", "b.vpe"});
  EXPECT_NEAR(all["lost_m3"].get<double>(), kCrater_m3, 5e-3 * kCrater_m3);
  EXPECT_NEAR(all["gained_m3"].get<double>(), kPad_m3, 5e-3 * kPad_m3);
  EXPECT_EQ(all["median_m"], 0);
  EXPECT_EQ(all["nodata_area_m2"], 0);
  EXPECT_GT(all["threshold_m"].get<double>(), 0);  // the step of heights
  const double radius_m = all["radius_m"].get<double>();
  EXPECT_NEAR(all["area_m2"].get<double>(), 4 * M_PI * radius_m * radius_m, 1e-6 * radius_m * radius_m);
  const double changed_m2 = M_PI * (kCrater_m * kCrater_m + std::pow(kPad_m + kFalloff_m, 2));
  EXPECT_NEAR(all["changed_area_m2"].get<double>(), changed_m2, 0.03 * changed_m2);
  EXPECT_NEAR(all["least"]["difference_m"].get<double>(), -kDepth_m, 1);
  EXPECT_NEAR(all["least"]["lon_deg"].get<double>(), 20.4, 0.02);
  EXPECT_NEAR(all["least"]["lat_deg"].get<double>(), 9.2, 0.02);
  EXPECT_NEAR(all["most"]["difference_m"].get<double>(), kRise_m, 0.1);
  EXPECT_NE(all["earlier"]["identity"], all["later"]["identity"]);

  const json crater = compare({"a.vpe", "b.vpe", "--region", "20.1,8.9,20.7,9.5"});
  EXPECT_NEAR(crater["lost_m3"].get<double>(), kCrater_m3, 5e-3 * kCrater_m3);
  EXPECT_EQ(crater["gained_m3"], 0);
  const double side_rad = 0.6 * M_PI / 180;
  const double box_m2 = radius_m * radius_m * side_rad * side_rad * std::cos(9.2 * M_PI / 180);
  EXPECT_NEAR(crater["area_m2"].get<double>(), box_m2, 0.03 * box_m2);
  EXPECT_NEAR(crater["mean_m"].get<double>(), -kCrater_m3 / box_m2, 0.04 * kCrater_m3 / box_m2);

  const json deep = compare({"a.vpe", "b.vpe", "--threshold", "100"});
  EXPECT_NEAR(deep["changed_area_m2"].get<double>(), M_PI * kCrater_m * kCrater_m / 2,
              0.02 * M_PI * kCrater_m * kCrater_m);
}

// The square that a camera 5 km above the pad's level part sees.
TEST_F(Compare, AViewCountsWhatItShows) {
  const json seen = compare({"a.vpe", "b.vpe", "--pose", "21.2,9.2,0,0,-90,0", "--height", "5000", "--fov",
                             "60", "--size", "100x100"});
  const double side_m = 2 * 5000 * std::tan(M_PI / 6);
  EXPECT_NEAR(seen["area_m2"].get<double>(), side_m * side_m, 0.08 * side_m * side_m);
  EXPECT_NEAR(seen["mean_m"].get<double>(), kRise_m, 0.1);
  EXPECT_NEAR(seen["median_m"].get<double>(), kRise_m, 0.1);
  const json sky = compare({"a.vpe", "b.vpe", "--pose", "21.2,9.2,0,0,80,0", "--height", "5000"});
  EXPECT_EQ(sky["area_m2"], 0);
  EXPECT_TRUE(sky["mean_m"].is_null());
  EXPECT_TRUE(sky["least"].is_null());
  // From the plain, the slope of the pad hides its top; from above it does not.
  const auto top_m2 = [&](const std::string& height_m) {
    return compare({"a.vpe", "b.vpe", "--pose", "20.9,9.2,0,90,0,0", "--height", height_m, "--threshold",
                    "99"})["changed_area_m2"]
        .get<double>();
  };
  EXPECT_LT(top_m2("2"), 1e-3 * M_PI * kPad_m * kPad_m);
  EXPECT_GT(top_m2("3000"), 0.95 * M_PI * kPad_m * kPad_m);
}

TEST_F(Compare, SwappedAndSame) {
  const json there = compare({"a.vpe", "b.vpe"});
  const json back = compare({"b.vpe", "a.vpe", "--threads", "1"});
  EXPECT_EQ(there["gained_m3"], back["lost_m3"]);
  EXPECT_EQ(there["lost_m3"], back["gained_m3"]);
  EXPECT_EQ(there["mean_m"].get<double>(), -back["mean_m"].get<double>());
  EXPECT_EQ(there["changed_area_m2"], back["changed_area_m2"]);
  const json same = compare({"b.vpe", "b.vpe"});
  for (const char* key : {"changed_area_m2", "gained_m3", "lost_m3", "mean_m", "rms_m", "median_m"})
    EXPECT_EQ(same[key], 0) << key;
  const Result text = vpe({"compare", "b.vpe", "b.vpe", "-q"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("volume: gained 0 m3, lost 0 m3"), std::string::npos) << text.out;
}

TEST_F(Compare, BadInputIsRefused) {
  Dem ball;
  ball.radius_m = 3000000;
  write_dem(dir_ / "ball.tif", ball);
  succeed({"build", "ball.tif", "-o", "ball.vpe", "--base-spacing", "200000", "--body", "Mars", "--radius",
           "3000000", "--datum", "sphere:3000000"});
  expect_failure({"compare", "a.vpe", "ball.vpe"}, 1, {"a.vpe", "ball.vpe", "radius", "3000000"});
  expect_failure({"compare", "a.vpe", "none.vpe"}, 1, {"none.vpe"});
  expect_failure({"compare", "a.vpe"}, 2, {"LATER"});
  expect_failure({"compare", "a.vpe", "b.vpe", "--region", "1,2,3"}, 2, {"--region", "1,2,3"});
  expect_failure({"compare", "a.vpe", "b.vpe", "--region", "1,9,3,-9"}, 2, {"--region", "south"});
  expect_failure({"compare", "a.vpe", "b.vpe", "--region", "1,2,3,4", "--pose", "1,2,3"}, 2,
                 {"--region", "--pose"});
  expect_failure({"compare", "a.vpe", "b.vpe", "--height", "3"}, 2, {"--pose"});
  expect_failure({"compare", "a.vpe", "b.vpe", "--threshold", "-1"}, 2, {"--threshold"});
  expect_failure({"compare", "a.vpe", "b.vpe", "--threshold", "nan"}, 2, {"--threshold"});
  expect_failure(
      {"render", "b.vpe", "--compare", "ball.vpe", "--pose", "21.2,9.2,50000,0,-90,0", "-o", "x.png"}, 1,
      {"ball.vpe", "radius"});
  expect_failure(
      {"render", "b.vpe", "--set", "colour=difference", "--pose", "21.2,9.2,50000,0,-90,0", "-o", "x.png"}, 2,
      {"--compare"});
  EXPECT_FALSE(exists("x.png"));
  damage_payloads(dir_ / "b.vpe", "heights");
  expect_failure({"compare", "a.vpe", "b.vpe"}, 1, {"b.vpe", "damaged"});
}

}  // namespace
}  // namespace app_test
