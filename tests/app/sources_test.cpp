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

TEST_F(Sources, ASilentDatumIsStatedOrDeclaredTheSame) {
  write_globe_and_inset(590);
  Result result = build({"--datum", "globe.tif=areoid"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"inset.tif does not state its vertical datum", "m above", "globe.tif",
                                "--datum inset.tif=areoid"}));
  EXPECT_EQ(leftovers(), Words{});
  result = build({"--datum", "globe.tif=areoid", "--datum", "inset.tif=same", "--json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(parse_json(result.out)["datum"], "areoid");
  EXPECT_TRUE(says(parse_json(result.out)["sources"].dump(), {"datum named as areoid"}));
  EXPECT_EQ(build({}).exit_code, 1);
  EXPECT_EQ(build({"--datum", "same"}).exit_code, 0);
  expect_failure({"build", "globe.tif", "-o", "p.vpe", "--datum", "other.tif=same"}, 2, {"other.tif"});
}

TEST_F(Sources, MoreBandsAreNoted) {
  write_globe_and_inset(0);
  const std::string band =
      "<VRTRasterBand dataType=\"Int16\" band=\"B\"><Description>height</Description><SimpleSource><SourceFilename "
      "relativeToVRT=\"1\">globe.tif</SourceFilename></SimpleSource></VRTRasterBand>";
  std::string second = band;
  second[second.find("\"B\"") + 1] = '2';
  std::string first = band;
  first[first.find("\"B\"") + 1] = '1';
  write_text(dir_ / "two.vrt",
             "<VRTDataset rasterXSize=\"180\" rasterYSize=\"90\"><SRS>+proj=longlat +R=3396190 +no_defs</SRS>"
             "<GeoTransform>-180,2,0,90,0,-2</GeoTransform>" +
                 first + second + "</VRTDataset>");
  const Result result = vpe({"build", "two.vrt", "-o", "p.vpe", "--base-spacing", "100000"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.err, {"two.vrt has 2 bands", "the first ('height')", "gdal_translate -b"}));
}

TEST_F(Sources, TheSagOfCoarseFacetsIsNoted) {
  write_dem(dir_ / "m.tif");
  const Result coarse = vpe({"build", "m.tif", "-o", "p.vpe", "--base-spacing", "100000"});
  EXPECT_TRUE(says(coarse.err, {"41.71 km apart", "up to 213 m below", "--base-spacing"}));
  const Result finer = vpe({"build", "m.tif", "-o", "p.vpe", "--base-spacing", "6000"});
  EXPECT_EQ(finer.err.find("facets"), std::string::npos) << finer.err;
}

// Only the part that a mosaic has is built finely, however large it says to be.
TEST_F(Sources, AMosaicWithOnePartCostsThatPart) {
  Dem part;
  part.width = 50;
  part.height = 40;
  part.west_deg = 10;
  part.north_deg = 20;
  part.cell_deg = 0.0018;
  part.height_m = [](int column, int row) { return 500 + column + row; };
  write_dem(dir_ / "part.tif", part);
  const auto mosaic = [&](const std::string& source) {
    // Columns 105556 and rows 33889 of 200 000 x 18 000, 0.0018 degrees each.
    return "<VRTDataset rasterXSize=\"200000\" rasterYSize=\"18000\"><SRS>+proj=longlat +R=3396190 +no_defs</SRS>"
           "<GeoTransform>-180,0.0018,0,25,0,-0.0018</GeoTransform><VRTRasterBand dataType=\"Float32\" "
           "band=\"1\"><NoDataValue>-32768</NoDataValue>" +
           source + "</VRTRasterBand></VRTDataset>";
  };
  write_text(dir_ / "m.vrt",
             mosaic("<SimpleSource><SourceFilename relativeToVRT=\"1\">part.tif</SourceFilename>"
                    "<SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"50\" "
                    "ySize=\"40\"/><DstRect xOff=\"105556\" yOff=\"2778\" xSize=\"50\" "
                    "ySize=\"40\"/></SimpleSource>"));
  const Words words{"build", "m.vrt", "-o", "p.vpe", "--base-spacing", "100000", "--json", "-q"};
  Words estimate = words;
  estimate.push_back("--estimate");
  const Result estimated = vpe(estimate);
  ASSERT_EQ(estimated.exit_code, 0) << estimated.err;
  EXPECT_LT(parse_json(estimated.out)["posts"].get<double>(), 20e6);
  ASSERT_EQ(vpe(words).exit_code, 0);
  const auto at = parse_json(vpe({"query", "p.vpe", "10.0450,19.9643", "--json"}).out)[0];
  EXPECT_NEAR(at["elevation_m"].get<double>(), 500 + 24 + 19, 3);
  // Without any part it is refused at once.
  write_text(dir_ / "none.vrt", mosaic(""));
  expect_failure({"build", "none.vrt", "-o", "q.vpe"}, 1, {"none.vrt", "holds no elevation"});
  std::string huge = mosaic("");
  huge.replace(huge.find("200000"), 6, "2000000000").replace(huge.find("18000"), 5, "1000000000");
  huge.replace(huge.find("0.0018"), 6, "1.8e-7").replace(huge.find("-0.0018"), 7, "-1.8e-7");
  write_text(dir_ / "huge.vrt", huge);
  expect_failure({"build", "huge.vrt", "-o", "q.vpe"}, 1, {"huge.vrt", "holds no elevation"});
}

TEST_F(Sources, ImagesOfAnotherBodyAreRefused) {
  write_dem(dir_ / "m.tif");
  write_text(dir_ / "moon.vrt",
             "<VRTDataset rasterXSize=\"36\" rasterYSize=\"18\"><SRS>+proj=longlat +R=1737400 +no_defs</SRS>"
             "<GeoTransform>-180,10,0,90,0,-10</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"/>"
             "</VRTDataset>");
  expect_failure({"build", "m.tif", "--image", "moon.vrt", "-o", "p.vpe"}, 1,
                 {"moon.vrt", "1737400", "3396190", "--body"});
  EXPECT_EQ(leftovers(), Words{});
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

TEST_F(Sources, RadiiAreAnsweredAsSuch) {
  write_globe_and_inset(0);
  const Result result = build({"--datum", "ellipsoid:3396190,3376200", "--to-datum=radius", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(
      says(result.err, {"distances from the centre are stored as heights", "sphere:3396190", "radius_m"}));
  const json answer = parse_json(vpe({"query", "p.vpe", "10,40", "--json"}).out)[0];
  EXPECT_NEAR(answer["radius_m"].get<double>(), 3396190 + answer["elevation_m"].get<double>(), 1e-6);
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

// Maps of small bodies are on spheres of any radius.
TEST_F(Sources, BodiesThatTheRasterNames) {
  const auto body_of = [&](const std::string& crs) {
    write_text(dir_ / "b.vrt",
               "<VRTDataset rasterXSize=\"180\" rasterYSize=\"90\"><SRS>" + crs +
                   "</SRS><GeoTransform>-180,2,0,90,0,-2</GeoTransform><VRTRasterBand dataType=\"Int16\" "
                   "band=\"1\"/></VRTDataset>");
    const Result result =
        vpe({"build", "b.vrt", "-o", "b.vpe", "--base-spacing", "100000", "--json", "-q", "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json built = parse_json(result.out);
    return std::pair(built["body"].get<std::string>(), built["radius_m"].get<double>());
  };
  const auto system = [](const std::string& name, const std::string& radius) {
    return "GEOGCS[\"GCS_" + name + "_2000\",DATUM[\"D_" + name + "_2000\",SPHEROID[\"s\"," + radius +
           ",0]],PRIMEM[\"m\",0],UNIT[\"degree\",0.0174532925199433]]";
  };
  EXPECT_EQ(body_of(system("Vesta", "285000")), std::pair(std::string("Vesta"), 285000.0));
  EXPECT_EQ(body_of(system("Bennu", "285000")), std::pair(std::string("unnamed"), 285000.0));
  EXPECT_EQ(body_of(system("Mars", "3396000")), std::pair(std::string("Mars"), 3396190.0));
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
