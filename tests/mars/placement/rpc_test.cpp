// Rasters that an RPC places, against the polynomials themselves, at one height and on a DEM.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "mars/geodesy/bodies.h"
#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/placed_sources.h"
#include "mars/raster/placement/memory_file.h"
#include "mars/raster/placement/rpc_model.h"
#include "tests/mars/placement/placed_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::height_at;
using Values = std::map<std::string, std::string>;

constexpr int kWidth = 260;
constexpr int kHeight = 200;
constexpr double kMost_px = 0.05;

// Offsets and scales of the RPC.
constexpr double kLon_deg = 137.4;
constexpr double kLat_deg = -4.7;
constexpr double kSpan_deg = 0.5;
constexpr double kMean_m = -4400;
constexpr double kHeightSpan_m = 2000;

std::string coefficients(const std::map<int, double>& values) {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += (i > 0 ? " " : "") + std::to_string(values.contains(i) ? values.at(i) : 0.0);
  return text;
}

Values rpc() {
  return {{"LINE_OFF", "100"},
          {"SAMP_OFF", "130"},
          {"LAT_OFF", std::to_string(kLat_deg)},
          {"LONG_OFF", std::to_string(kLon_deg)},
          {"HEIGHT_OFF", std::to_string(kMean_m)},
          {"LINE_SCALE", "100"},
          {"SAMP_SCALE", "130"},
          {"LAT_SCALE", std::to_string(kSpan_deg)},
          {"LONG_SCALE", std::to_string(kSpan_deg)},
          {"HEIGHT_SCALE", std::to_string(kHeightSpan_m)},
          // Terms: 1 L P H LP LH PH LL PP HH ..., of L longitude, P latitude, H height.
          {"LINE_NUM_COEFF", coefficients({{1, 0.05}, {2, -1.0}, {3, 0.1}})},
          {"LINE_DEN_COEFF", coefficients({{0, 1}})},
          {"SAMP_NUM_COEFF", coefficients({{1, 0.95}, {2, 0.04}, {3, 0.2}, {7, 0.02}})},
          {"SAMP_DEN_COEFF", coefficients({{0, 1}, {1, 0.01}})}};
}

// Returns sample and line, counted from 0 at the centre of the first pixel.
glm::dvec2 by_polynomials(double lon_deg, double lat_deg, double height_m) {
  const double l = (lon_deg - kLon_deg) / kSpan_deg;
  const double p = (lat_deg - kLat_deg) / kSpan_deg;
  const double h = (height_m - kMean_m) / kHeightSpan_m;
  const double sample = (0.95 * l + 0.04 * p + 0.2 * h + 0.02 * l * l) / (1 + 0.01 * l);
  const double line = 0.05 * l - p + 0.1 * h;
  return {130 + 130 * sample, 100 + 100 * line};
}

double ground_m(double lon_deg, double lat_deg) {
  return kMean_m + 900 * std::sin(8 * (lon_deg - kLon_deg)) + 1200 * (lat_deg - kLat_deg);
}

class Rpc : public ::testing::Test {
 protected:
  std::string file(const std::string& name, bool rows, const Values& values = rpc()) const {
    const std::string path = source_files::write(folder_ / name, placed_files::numbers(kWidth, kHeight, rows));
    placed_files::set_rpc(path, values);
    return path;
  }

  std::string dem(const std::string& name = "dem.tif", double west_deg = 136.5) const {
    source_files::Raster raster;
    raster.width = 900;
    raster.height = 900;
    raster.geotransform = source_files::box(west_deg, -3.8, west_deg + 1.8, -5.6, 900, 900);
    raster.value = [=](int, int column, int row) {
      return ground_m(west_deg + (column + 0.5) * 0.002, -3.8 - (row + 0.5) * 0.002);
    };
    return source_files::write(folder_ / name, raster);
  }

  void expect_rpc(const mars::PlacementOptions& options, const std::function<double(double, double)>& height_m,
                  double latitude_scale = 1) const {
    const auto columns = mars::open_elevation(file("c.tif", false), options);
    const auto rows = mars::open_elevation(file("r.tif", true), options);
    test_support::Random random(4);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const double lon = kLon_deg + random.uniform(-0.8, 0.8);
      const double lat = kLat_deg + random.uniform(-0.8, 0.8);
      const glm::dvec2 at = by_polynomials(lon, lat, height_m(lon, lat));
      const double centric =
          std::atan(std::tan(lat * mars::kRadiansPerDegree) * latitude_scale) / mars::kRadiansPerDegree;
      const double column = height_at(*columns, {lon, centric});
      if (at.x < -4 || at.x > kWidth + 3 || at.y < -4 || at.y > kHeight + 3) {
        EXPECT_TRUE(std::isnan(column));
      }
      if (at.x < 3 || at.x > kWidth - 4 || at.y < 3 || at.y > kHeight - 4) continue;
      ++inside;
      EXPECT_NEAR(column, at.x, kMost_px) << lon << " " << lat;
      EXPECT_NEAR(height_at(*rows, {lon, centric}), at.y, kMost_px) << lon << " " << lat;
    }
    EXPECT_GT(inside, 300);
  }

  std::string error(const Values& values, const mars::PlacementOptions& options = {}) const {
    try {
      mars::open_elevation(file("e.tif", false, values), options);
    } catch (const mars::SourceError& e) {
      EXPECT_NE(std::string(e.what()).find("e.tif"), std::string::npos) << e.what();
      return e.what();
    }
    return {};
  }

  test_support::TempDir folder_;
};

TEST_F(Rpc, AtItsOwnHeightAndAtAnother) {
  expect_rpc({}, [](double, double) { return kMean_m; });
  expect_rpc({.rpc_height_m = -3400}, [](double, double) { return -3400; });
  const auto own = mars::open_elevation(file("n.tif", false))->infos().at(0);
  EXPECT_NE(own.notes.at(0).find("placed by its RPC at a height of -4400 m, its own mean height (--rpc-height"),
            std::string::npos)
      << own.notes.at(0);
  EXPECT_NE(own.notes.at(1).find("planetocentric degrees on a sphere of 3396190 m (--rpc-crs"),
            std::string::npos);
  EXPECT_EQ(own.treatment, "placed by its RPC at a height of -4400 m");
  EXPECT_NEAR(own.body_radius_m, 3396190, 1e-6);
}

TEST_F(Rpc, OnADem) {
  expect_rpc({.rpc_dem = dem()}, ground_m);
  const auto info = mars::open_elevation(file("n.tif", false), {.rpc_dem = dem()})->infos().at(0);
  EXPECT_EQ(info.treatment, "placed by its RPC on the heights of dem.tif");
  EXPECT_NE(info.notes.at(0).find("placed by its RPC on the heights of"), std::string::npos);
}

TEST_F(Rpc, LatitudesAreThoseOfItsSystem) {
  const double k = 3376200.0 / 3396190 * 3376200 / 3396190;
  expect_rpc(
      {.rpc_crs = "+proj=longlat +a=3396190 +b=3376200 +no_defs"}, [](double, double) { return kMean_m; }, k);
  // The DEM counts planetocentric latitudes: the same place has another latitude there.
  const auto height_m = [k](double lon, double lat) {
    return ground_m(lon, std::atan(std::tan(lat * mars::kRadiansPerDegree) * k) / mars::kRadiansPerDegree);
  };
  expect_rpc({.rpc_dem = dem(), .rpc_crs = "+proj=longlat +a=3396190 +b=3376200 +no_defs"}, height_m, k);
}

TEST_F(Rpc, TheBodyOfTheBuildIsAssumed) {
  const auto moon = mars::open_elevation(file("m.tif", false), {.body_radius_m = 1737400})->infos().at(0);
  EXPECT_NEAR(moon.body_radius_m, 1737400, 1e-6);
  const auto earth =
      mars::open_elevation(file("m.tif", false), {.body_radius_m = mars::find_body("Earth")->radius_m})
          ->infos()
          .at(0);
  EXPECT_NEAR(earth.body_radius_m, 6378137, 1e-6);
  EXPECT_EQ(earth.notes.size(), 1U);
}

TEST_F(Rpc, AgreesWithGdaltransform) {
  const std::string path = file("g.tif", false);
  const auto source = mars::open_elevation(path, {.rpc_height_m = -4000});
  for (const glm::dvec2 place : {glm::dvec2(137.3, -4.6), {137.7, -4.9}, {137.1, -4.5}}) {
    const std::string text = placed_files::run_tool("gdaltransform -i -rpc -to RPC_HEIGHT=-4000 " + path,
                                                    std::to_string(place.x) + " " + std::to_string(place.y));
    if (text.empty()) GTEST_SKIP() << "gdaltransform is not installed";
    glm::dvec2 pixel;
    ASSERT_EQ(std::sscanf(text.c_str(), "%lf %lf", &pixel.x, &pixel.y), 2) << text;
    EXPECT_NEAR(height_at(*source, {place.x, place.y}), pixel.x - 0.5, kMost_px);
  }
}

TEST_F(Rpc, PointsCountWithTheirMethodAlone) {
  const std::string path = file("b.tif", false);
  placed_files::set_points(
      path, {{{0, 0}, {10, 10}}, {{260, 0}, {12, 10}}, {{0, 200}, {10, 8}}, {{260, 200}, {12, 8}}},
      source_files::kSphere);
  const auto by_rpc = mars::open_elevation(path);
  EXPECT_TRUE(std::isfinite(height_at(*by_rpc, {kLon_deg, kLat_deg})));
  EXPECT_NE(by_rpc->infos().at(0).notes.at(0).find("its 4 control points count with --gcp-method"),
            std::string::npos);
  const auto by_points = mars::open_elevation(path, {.gcp_method = mars::GcpMethod::kPolynomial1});
  EXPECT_TRUE(std::isnan(height_at(*by_points, {kLon_deg, kLat_deg})));
  EXPECT_NEAR(height_at(*by_points, {11, 9}), 129.5, kMost_px);
}

TEST_F(Rpc, StampsNoticeAChangedDem) {
  const std::string heights = dem();
  const std::string path = file("s.tif", false);
  const auto source = mars::open_elevation(path, {.rpc_dem = heights});
  const auto files = source->infos().at(0).files;
  EXPECT_EQ(mars::changed_file(files), "");
  source_files::write(heights, [] {
    source_files::Raster raster;
    raster.width = raster.height = 3;
    return raster;
  }());
  EXPECT_EQ(mars::changed_file(files), heights);
}

TEST_F(Rpc, BadValuesAreRefused) {
  EXPECT_EQ(error(rpc()), "");
  const auto expect_words = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << words << "\n" << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
  };
  expect_words(error({}, {.rpc_crs = ""}), "has no georeference, no control points and no RPC");
  const std::string dem_path = dem();
  expect_words(error(rpc(), {.rpc_height_m = 1, .rpc_dem = dem_path}), "has both --rpc-height and --rpc-dem");
  expect_words(error(rpc(), {.rpc_crs = "nonsense"}), "PROJ does not know --rpc-crs 'nonsense'");
  expect_words(error(rpc(), {.rpc_crs = "IAU_2015:49910"}), "'IAU_2015:49910' is not geographic");
  expect_words(error(rpc(), {.rpc_crs = "IAU_2015:49901"}), "counts longitudes to the west");
  expect_words(error(rpc(), {.rpc_dem = dem("far.tif", 20)}), "far.tif: as --rpc-dem of ");
  source_files::Raster radii;
  radii.width = radii.height = 20;
  radii.geotransform = source_files::box(136, -3, 139, -6, 20, 20);
  radii.value = [](int, int, int) { return 3391000; };
  expect_words(error(rpc(), {.rpc_dem = source_files::write(folder_ / "radii.tif", radii)}), "holds radii");
  // Errors of the DEM itself are told in its own name.
  const auto error_of_dem = [&](const mars::PlacementOptions& options) -> std::string {
    try {
      mars::open_elevation(file("e.tif", false), options);
    } catch (const mars::SourceError& e) {
      return e.what();
    }
    return {};
  };
  expect_words(error_of_dem({.rpc_dem = (folder_ / "none.tif").string()}), "none.tif: cannot open");
  expect_words(error_of_dem({.rpc_dem = dem_path, .body_radius_m = 1737400}), "dem.tif");
}

TEST_F(Rpc, TheModelHasWhatGdalNeeds) {
  const mars::GdalScope scope;
  const std::string path = file("g.tif", false);
  const std::unique_ptr<GDALDataset> dataset(GDALDataset::FromHandle(GDALOpen(path.c_str(), GA_ReadOnly)));
  const mars::RpcModel own = mars::rpc_model(path, *dataset, {});
  EXPECT_EQ(own.metadata.size(), 14U);
  EXPECT_EQ(own.transformer_options(), (std::vector<std::string>{"METHOD=RPC", "RPC_HEIGHT=-4400"}));
  EXPECT_EQ(own.treatment(), "placed by its RPC at a height of -4400 m");
  EXPECT_TRUE(own.dem_files.empty());
  const std::string heights = dem();
  const mars::RpcModel on_dem = mars::rpc_model(path, *dataset, {.rpc_dem = heights});
  ASSERT_NE(on_dem.dem, nullptr);
  EXPECT_EQ(on_dem.dem_files, std::vector<std::string>{heights});
  EXPECT_EQ(on_dem.transformer_options().at(1), "RPC_DEM=" + on_dem.dem->name());
}

// GDAL keeps an incomplete RPC only in its own side files, and a complete one in the TIFF.
TEST_F(Rpc, MissingValuesAreNamed) {
  const auto error_without = [&](const std::string& key, const std::string& value) {
    std::string items;
    for (const auto& [name, text] : rpc()) {
      if (name != key) items += "<MDI key=\"" + name + "\">" + text + "</MDI>";
    }
    if (!value.empty()) items += "<MDI key=\"" + key + "\">" + value + "</MDI>";
    source_files::write(folder_ / "v.tif", placed_files::numbers(8, 8, false));
    source_files::write_text(
        folder_ / "v.vrt",
        "<VRTDataset rasterXSize=\"8\" rasterYSize=\"8\"><Metadata domain=\"RPC\">" + items +
            "</Metadata><VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
            "relativeToVRT=\"1\">v.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
    return source_files::elevation_error((folder_ / "v.vrt").string());
  };
  for (const auto& [key, value] : rpc()) {
    const std::string message = error_without(key, "");
    EXPECT_NE(message.find("v.vrt: its RPC has no usable " + key), std::string::npos) << message;
  }
  EXPECT_NE(error_without("LAT_SCALE", "0").find("its RPC has no usable LAT_SCALE: 0;"), std::string::npos);
  EXPECT_NE(error_without("LINE_OFF", "ten").find("LINE_OFF: ten;"), std::string::npos);
  EXPECT_NE(error_without("LINE_NUM_COEFF", "1 2 3").find("must have 20 numbers"), std::string::npos);
  EXPECT_NE(error_without("LINE_NUM_COEFF", coefficients({})).find("v.vrt"), std::string::npos);
}

}  // namespace
