// vpe build: datums, vertical alignment, outliers and bodies, as users give them.
#include <cmath>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

class Sources : public AppTest {
 protected:
  // A globe and an inset of 10 degrees that lies `off_m` above it.
  void write_globe_and_inset(double off_m) {
    write_dem(dir_ / "globe.tif");
    Dem inset;
    inset.width = inset.height = 60;
    inset.west_deg = 20;
    inset.north_deg = 10;
    inset.cell_deg = 1.0 / 6;
    inset.height_m = [off_m](int column, int row) {
      const double lon = 20 + (column + 0.5) / 6;
      const double lat = 10 - (row + 0.5) / 6;
      return off_m + 3000 * std::sin(3 * 2 * M_PI * (lon + 179) / 360) * std::cos(lat * M_PI / 180);
    };
    write_dem(dir_ / "inset.tif", inset);
  }
  Result build(const Words& more) const {
    Words words{"build", "--force",        "globe.tif", "inset.tif", "-o",
                "p.vpe", "--base-spacing", "100000",    "--spacing", "20000"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }
};

TEST_F(Sources, DatumsAreNamedRefusedAndConverted) {
  write_globe_and_inset(0);
  Result result = build({"--datum", "globe.tif=areoid", "--datum", "inset.tif=sphere:3396000"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(
      says(result.err, {"globe.tif", "'areoid'", "inset.tif", "'sphere:3396000'", "median", "--to-datum"}));
  EXPECT_EQ(leftovers(), Words{});
  // Between spheres nothing but the radii is needed.
  result = build({"--datum", "globe.tif=sphere:3396190", "--datum", "inset.tif=sphere:3396000", "--to-datum",
                  "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  json built = parse_json(result.out);
  EXPECT_EQ(built["datum"], "sphere:3396190");
  EXPECT_EQ(built["shape"], "sphere");
  EXPECT_TRUE(says(built["sources"][0]["treatment"], {"converted from sphere:3396000 to sphere:3396190"}));
  const json at = parse_json(vpe({"query", "p.vpe", "25,5", "--json"}).out)[0];
  EXPECT_EQ(at["datum"], "sphere:3396190");
  EXPECT_NEAR(at["elevation_m"].get<double>(),
              3000 * std::sin(3 * 2 * M_PI * 204 / 360) * std::cos(5 * M_PI / 180) - 190, 30);
  // A flag in a configuration file means the same as on the command line.
  write_text(dir_ / "c.toml", "[build]\nto-datum = true\n");
  result = build({"--datum", "globe.tif=sphere:3396190", "--datum", "inset.tif=sphere:3396000", "--config",
                  "c.toml", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(parse_json(result.out)["datum"], "sphere:3396190");
  // One datum for all rasters that do not state theirs.
  result = build({"--datum", "areoid", "--json", "-q"});
  EXPECT_EQ(parse_json(result.out)["datum"], "areoid");
  EXPECT_EQ(parse_json(result.out)["notes"].size(), 0U);
  EXPECT_TRUE(says(vpe({"info", "p.vpe"}).out, {"vertical datum", "areoid"}));
}

TEST_F(Sources, TrueRadii) {
  write_globe_and_inset(0);
  const Result result = build({"--datum", "ellipsoid:3396190,3376200", "--shape", "radius", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json built = parse_json(result.out);
  EXPECT_EQ(built["shape"], "radius");
  EXPECT_EQ(built["datum"], "sphere:3396190");
  // The poles of the ellipsoid lie 20 km below the sphere.
  const json pole = parse_json(vpe({"query", "p.vpe", "0,90", "--json"}).out)[0];
  EXPECT_NEAR(pole["elevation_m"].get<double>(), -19990, 400);
  EXPECT_TRUE(says(vpe({"info", "p.vpe"}).out, {"true radii"}));
}

TEST_F(Sources, AlignmentIsReported) {
  write_globe_and_inset(700);
  Result result = build({"--align", "plane", "--datum", "areoid"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, {"inset.tif lies", "m above the base", "tilt", "RMS difference there was"}));
  result = build({"--align", "edges", "--datum", "areoid", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, {"the base is warped to meet inset.tif"}));
  EXPECT_NEAR(parse_json(result.out)["findings"][1]["bend"]["rms_m"].get<double>(), 700, 100);
  EXPECT_TRUE(parse_json(result.out)["findings"][1]["level"].is_null());
}

TEST_F(Sources, BodiesByNameAndBySource) {
  write_dem(dir_ / "m.tif");
  Words words{"build", "m.tif", "-o", "m.vpe", "--force", "--base-spacing", "100000", "--json", "-q"};
  const auto with = [&](const Words& more) {
    Words all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  json built = parse_json(vpe(words).out);
  EXPECT_EQ(built["body"], "Mars");
  EXPECT_EQ(built["radius_m"], 3396190);
  built = parse_json(vpe(with({"--radius", "3397200"})).out);
  EXPECT_EQ(built["radius_m"], 3397200);
  expect_failure(with({"--body", "moon"}), 1, {"m.tif", "3396190", "1737400", "--body"});
  expect_failure(with({"--body", "Nibiru"}), 2, {"Nibiru", "--radius"});
}

TEST_F(Sources, BadOptions) {
  write_globe_and_inset(0);
  const Words base{"build", "globe.tif", "inset.tif", "-o", "p.vpe"};
  const auto with = [&](const Words& more) {
    Words all = base;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_failure(with({"--datum", "sealevel"}), 2, {"--datum", "'sealevel'", "areoid"});
  expect_failure(with({"--datum", "other.tif=areoid"}), 2, {"other.tif", "no raster is called"});
  expect_failure(with({"--to-datum=up"}), 2, {"--to-datum", "'up'"});
  expect_failure(with({"--datum", "areoid", "--shape", "radius"}), 1, {"areoid", "--areoid"});
  expect_failure(with({"--areoid", "none.tif"}), 1, {"none.tif", "No such file"});
  expect_failure(with({"--align", "up"}), 2, {"--align", "plane", "edges"});
  expect_failure(with({"--feather", "-1"}), 2, {"--feather"});
  expect_failure(with({"--shape", "egg"}), 2, {"--shape", "radius"});
}

}  // namespace
}  // namespace app_test
