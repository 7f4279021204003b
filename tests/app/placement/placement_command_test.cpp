// vpe build and vpe patch of rasters without a map, as users give their options.
#include "tests/app/support/app_fixture.h"
#include "vpe/app/planet/build_request.h"
#include "vpe/app/planet/placement_option.h"

namespace app_test {
namespace {

using nlohmann::json;
using vpe::app::PlacementArguments;

class PlacementCommand : public AppTest {
 protected:
  void SetUp() override {
    write_dem(dir_ / "globe.tif");
    Dem scan;
    scan.width = scan.height = 60;
    scan.georeference = false;
    scan.height_m = [](int column, int row) { return 1000 + column + 2 * row; };
    write_dem(dir_ / "scan.tif", scan);
  }

  // Writes a raster of scan.tif that has more than its pixels.
  void write_scan(const std::string& name, const std::string& more) const {
    write_text(dir_ / name,
               "<VRTDataset rasterXSize=\"60\" rasterYSize=\"60\">" + more +
                   "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
                   "relativeToVRT=\"1\">scan.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
  }

  // 10 pixels a degree, from 20 E, 10 N.
  void write_points(const std::string& name) const {
    std::string points = "<GCPList Projection=\"+proj=longlat +R=3396190 +no_defs\">";
    for (const auto& [pixel, line] : {std::pair{0, 0}, {60, 0}, {0, 60}, {60, 60}}) {
      points += "<GCP Id=\"P\" Pixel=\"" + std::to_string(pixel) + "\" Line=\"" + std::to_string(line) +
                "\" X=\"" + std::to_string(20 + pixel / 10.0) + "\" Y=\"" + std::to_string(10 - line / 10.0) +
                "\"/>";
    }
    write_scan(name, points + "</GCPList>");
  }

  // The same map by an RPC of which the height moves 1 pixel for each 1000 m.
  void write_rpc(const std::string& name) const {
    const auto terms = [](int which, double value, int other, double other_value) {
      std::string text;
      for (int i = 0; i < 20; ++i)
        text += std::to_string(i == which ? value : i == other ? other_value : 0.0) + " ";
      return text;
    };
    std::string items;
    const std::pair<const char*, std::string> kValues[] = {{"LINE_OFF", "29.5"},
                                                           {"SAMP_OFF", "29.5"},
                                                           {"LAT_OFF", "7"},
                                                           {"LONG_OFF", "23"},
                                                           {"HEIGHT_OFF", "0"},
                                                           {"LINE_SCALE", "30"},
                                                           {"SAMP_SCALE", "30"},
                                                           {"LAT_SCALE", "3"},
                                                           {"LONG_SCALE", "3"},
                                                           {"HEIGHT_SCALE", "3000"},
                                                           {"LINE_NUM_COEFF", terms(2, -1, -1, 0)},
                                                           {"LINE_DEN_COEFF", terms(0, 1, -1, 0)},
                                                           {"SAMP_NUM_COEFF", terms(1, 1, 3, 0.1)},
                                                           {"SAMP_DEN_COEFF", terms(0, 1, -1, 0)}};
    for (const auto& [key, value] : kValues)
      items += std::string("<MDI key=\"") + key + "\">" + value + "</MDI>";
    write_scan(name, "<Metadata domain=\"RPC\">" + items + "</Metadata>");
  }

  Result build(const Words& more) const {
    Words words{"build",     "globe.tif", "-o",      "p.vpe", "--force",   "--base-spacing", "100000",
                "--spacing", "10000",     "--datum", "same",  "--feather", "10000"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  }

  double height_m(const std::string& place) const {
    return parse_json(vpe({"query", "p.vpe", place, "--json"}).out).at(0).at("elevation_m").get<double>();
  }
};

TEST_F(PlacementCommand, ElevationAndImageWithControlPoints) {
  write_points("points.vrt");
  const Result result = build({"points.vrt", "--image", "points.vrt", "--image-spacing", "20000"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(
      says(result.err, {"vpe: note: points.vrt: placed by its 4 control points with a polynomial of order 1; "
                        "they lie off it by 0 pixels (0 m) RMS"}));
  const json info = parse_json(vpe({"info", "p.vpe", "--json"}).out);
  EXPECT_EQ(info.at("image_sources").at(0).at("treatment"),
            "placed by its control points, polynomial of order 1");
  // 23 E, 7 N is the corner of four pixels in the middle.
  EXPECT_NEAR(height_m("23,7"), 1000 + 29.5 + 2 * 29.5, 3);
  EXPECT_NEAR(height_m("24.5,5.5"), 1000 + 44.5 + 2 * 44.5, 3);
}

TEST_F(PlacementCommand, RpcHeightsAndDems) {
  write_rpc("rpc.vrt");
  ASSERT_EQ(build({"rpc.vrt"}).exit_code, 0);
  EXPECT_NEAR(height_m("23,7"), 1000 + 29.5 + 2 * 29.5, 3);
  const Result high = build({"rpc.vrt", "--rpc-height", "rpc.vrt=10000"});
  ASSERT_EQ(high.exit_code, 0) << high.err;
  EXPECT_TRUE(says(high.err, {"rpc.vrt: placed by its RPC at a height of 10000 m", "planetocentric degrees"}));
  EXPECT_NEAR(height_m("23,7"), 1000 + 39.5 + 2 * 29.5, 3);
  Dem table;
  table.height_m = [](int, int) { return -10000; };
  write_dem(dir_ / "table.tif", table);
  const Result low = build({"rpc.vrt", "--rpc-dem", "table.tif"});
  ASSERT_EQ(low.exit_code, 0) << low.err;
  EXPECT_NEAR(height_m("23,7"), 1000 + 19.5 + 2 * 29.5, 3);
  // The planet keeps the option, and a patch opens the DEM again.
  EXPECT_TRUE(says(vpe({"info", "p.vpe", "--json"}).out, {"--rpc-dem=table.tif"}));
  write_points("points.vrt");
  const Result patched =
      vpe({"patch", "p.vpe", "--image", "points.vrt", "--gcp-method", "polynomial1", "-o", "q.vpe"});
  ASSERT_EQ(patched.exit_code, 0) << patched.err;
  EXPECT_TRUE(says(vpe({"info", "q.vpe", "--json"}).out, {"--gcp-method=points.vrt=polynomial1"}));
}

TEST_F(PlacementCommand, BadOptionsAreRefused) {
  write_points("points.vrt");
  write_rpc("rpc.vrt");
  const auto expect_usage = [&](const Words& more, const Words& parts) {
    Words words{"build", "globe.tif", "points.vrt", "-o", "p.vpe"};
    words.insert(words.end(), more.begin(), more.end());
    expect_failure(words, 2, parts);
  };
  expect_usage({"--gcp-method", "cubic"}, {"--gcp-method cubic", "polynomial1", "tps"});
  expect_usage({"--gcp-method", "other.tif=tps"}, {"--gcp-method other.tif=tps", "name of a raster"});
  expect_usage({"--rpc-height", "low"}, {"--rpc-height low", "metres"});
  expect_usage({"--rpc-height", "100001"}, {"--rpc-height 100001", "-100000 to 100000"});
  expect_failure({"build", "globe.tif", "points.vrt", "-o", "p.vpe", "--gcp-method", "polynomial2"}, 1,
                 {"points.vrt", "4 control points", "needs 6"});
  expect_failure({"build", "globe.tif", "rpc.vrt", "-o", "p.vpe", "--rpc-dem", "none.tif"}, 1,
                 {"none.tif", "cannot open"});
  expect_failure({"build", "globe.tif", "scan.tif", "-o", "p.vpe"}, 1,
                 {"scan.tif", "no georeference, no control points and no RPC"});
}

TEST(PlacementOption, ValuesWithANameComeFirst) {
  const std::vector<std::string> rasters{"a/one.tif", "two=x.tif"};
  PlacementArguments placement;
  placement.gcp_methods = {"one.tif=polynomial2", "tps"};
  placement.rpc_heights_m = {"-4400", "two=x.tif=12.5"};
  placement.rpc_dems = {"a/one.tif=b/dem.tif"};
  placement.rpc_systems = {"+proj=longlat +R=3396190"};
  const mars::PlacementOptions one = vpe::app::placement_of(placement, rasters[0], rasters, 1737400);
  EXPECT_EQ(one.gcp_method, mars::GcpMethod::kPolynomial2);
  EXPECT_EQ(one.rpc_height_m, -4400);
  EXPECT_EQ(one.rpc_dem, "b/dem.tif");
  EXPECT_EQ(one.rpc_crs, "+proj=longlat +R=3396190");
  EXPECT_EQ(one.body_radius_m, 1737400);
  const mars::PlacementOptions two = vpe::app::placement_of(placement, rasters[1], rasters, 0);
  EXPECT_EQ(two.gcp_method, mars::GcpMethod::kSpline);
  EXPECT_EQ(two.rpc_height_m, 12.5);
  EXPECT_EQ(two.rpc_dem, "");
  EXPECT_EQ(vpe::app::placement_files(placement, rasters), std::vector<std::string>{"b/dem.tif"});
}

TEST(PlacementOption, NamesFollowTheirFiles) {
  const std::vector<std::string> rasters{"a/one.tif"};
  PlacementArguments placement;
  placement.gcp_methods = {"a/one.tif=tps"};
  placement.rpc_dems = {"b/dem.tif"};
  vpe::app::rename_placement(placement, "a/one.tif", "c/one.tif", rasters);
  vpe::app::rename_placement(placement, "b/dem.tif", "c/dem.tif", rasters);
  EXPECT_EQ(placement.gcp_methods, std::vector<std::string>{"c/one.tif=tps"});
  EXPECT_EQ(placement.rpc_dems, std::vector<std::string>{"c/dem.tif"});
}

TEST(PlacementOption, OptionsOfAPatchAreForItsOwnRasters) {
  PlacementArguments planet;
  planet.gcp_methods = {"tps"};
  PlacementArguments patch;
  patch.gcp_methods = {"polynomial1", "y.tif=polynomial3"};
  vpe::app::add_placement(planet, patch, std::vector<std::string>{"x.tif", "y.tif"});
  EXPECT_EQ(planet.gcp_methods,
            (std::vector<std::string>{"tps", "x.tif=polynomial1", "y.tif=polynomial1", "y.tif=polynomial3"}));
}

TEST(PlacementOption, ArgumentsOfARequestAreReadBack) {
  vpe::app::BuildRequest request;
  request.dems = {"mola.tif"};
  request.images = {"scan.tif"};
  request.placement.gcp_methods = {"scan.tif=tps"};
  request.placement.rpc_heights_m = {"-4400"};
  request.placement.rpc_dems = {"mola.tif"};
  request.placement.rpc_systems = {"IAU_2015:49900"};
  const vpe::app::BuildRequest again = vpe::app::build_request(vpe::app::to_arguments(request));
  EXPECT_EQ(again.placement, request.placement);
  EXPECT_EQ(vpe::app::rasters_of(again), (std::vector<std::string>{"mola.tif", "scan.tif"}));
  EXPECT_EQ(vpe::app::files_of(again), (std::vector<std::string>{"mola.tif", "scan.tif", "mola.tif"}));
  std::vector<std::string> arguments;
  vpe::app::append_arguments(request.placement, arguments);
  EXPECT_EQ(arguments, (std::vector<std::string>{"--gcp-method=scan.tif=tps", "--rpc-height=-4400",
                                                 "--rpc-dem=mola.tif", "--rpc-crs=IAU_2015:49900"}));
}

}  // namespace
}  // namespace app_test
