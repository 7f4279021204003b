// vpe contour as a user runs it: against closed forms, and as GDAL reads its files.
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "tests/app/support/app_fixture.h"

namespace app_test {
namespace {

using nlohmann::json;

constexpr double kContourRadius_m = 3396190;
constexpr double kContourMetresPerDegree = kContourRadius_m * std::numbers::pi / 180;

struct ReadLine {
  double elevation_m = 0;
  std::vector<std::pair<double, double>> places;  // degrees east and north
};

class ContourCommand : public AppTest {
 protected:
  static void SetUpTestSuite() { planets_ = std::make_unique<test_support::TempDir>(); }
  static void TearDownTestSuite() { planets_.reset(); }

  // Returns a planet with a cone of 2000 m over 0.5 degrees, at 10 E on the equator, in a DEM of 160 x 160
  // posts. Made once for each name.
  std::string cone(const std::string& name, std::optional<double> no_data = std::nullopt) const {
    const std::string file = (*planets_ / (name + ".vpe")).string();
    if (std::filesystem::exists(file)) return file;
    Dem dem;
    dem.width = 160;
    dem.height = 160;
    dem.west_deg = 9.5;
    dem.north_deg = 0.5;
    dem.cell_deg = 0.00625;
    dem.no_data = no_data;
    dem.height_m = [no_data](int column, int row) {
      const double x = 9.5 + (column + 0.5) * 0.00625 - 10;
      const double y = 0.5 - (row + 0.5) * 0.00625;
      if (no_data && x > 0.1) return *no_data;
      return 2000 - 4000 * std::hypot(x, y);
    };
    write_dem(dir_ / (name + ".tif"), dem);
    const Result built = vpe({"build", name + ".tif", "-o", file, "--base-spacing", "60000", "-q"});
    EXPECT_EQ(built.exit_code, 0) << built.err;
    return file;
  }

  json contour(const std::string& planet, const Words& more) const {
    Words words{"contour", planet, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? parse_json(result.out) : json();
  }

  std::vector<ReadLine> read(const std::string& name) const {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path(name).c_str(), GDAL_OF_VECTOR));
    EXPECT_NE(file, nullptr);
    std::vector<ReadLine> lines;
    if (file == nullptr) return lines;
    EXPECT_STREQ(file->GetLayer(0)->GetName(), "contours");
    for (const auto& feature : file->GetLayer(0)) {
      ReadLine line{feature->GetFieldAsDouble("elevation_m"), {}};
      const OGRGeometry* geometry = feature->GetGeometryRef();
      const OGRLineString* points = wkbFlatten(geometry->getGeometryType()) == wkbMultiLineString
                                        ? geometry->toMultiLineString()->getGeometryRef(0)
                                        : geometry->toLineString();
      for (int n = 0; n < points->getNumPoints(); ++n)
        line.places.emplace_back(points->getX(n), points->getY(n));
      lines.push_back(std::move(line));
    }
    return lines;
  }

  static inline std::unique_ptr<test_support::TempDir> planets_;
};

TEST_F(ContourCommand, OfAConeAreCircles) {
  const std::string planet = cone("cone");
  const json summary = contour(
      planet, {"--box", "9.6,-0.4,10.4,0.4", "--interval", "250", "--spacing", "300", "-o", path("c.geojson")});
  const std::vector<ReadLine> lines = read("c.geojson");
  ASSERT_EQ(summary["lines"].get<std::size_t>(), lines.size());
  int circles = 0;
  for (const ReadLine& line : lines) {
    const double radius_deg = (2000 - line.elevation_m) / 4000;
    for (const auto& [lon, lat] : line.places) {
      EXPECT_NEAR(std::hypot(lon - 10, lat), radius_deg, 0.004) << line.elevation_m;
      EXPECT_TRUE(std::abs(lon - 10) <= 0.4 + 1e-9 && std::abs(lat) <= 0.4 + 1e-9);
    }
    if (radius_deg < 0.39) {
      ++circles;
      EXPECT_EQ(line.places.front(), line.places.back());
      // Higher ground on the right: clockwise.
      double area = 0;
      for (std::size_t n = 1; n < line.places.size(); ++n)
        area += (line.places[n - 1].first - 10) * line.places[n].second -
                (line.places[n].first - 10) * line.places[n - 1].second;
      EXPECT_LT(area, 0);
    }
  }
  EXPECT_EQ(circles, 6);  // 500 to 1750 m
  EXPECT_EQ(summary["highest_level_m"], 1750);
  EXPECT_EQ(summary["closed_lines"], 6);
}

TEST_F(ContourCommand, LengthsAreThoseOnTheSphere) {
  const json summary = contour(cone("cone"), {"--box", "9.6,-0.4,10.4,0.4", "--interval", "2000", "--base",
                                              "800", "--spacing", "200", "-o", path("one.gpkg")});
  EXPECT_EQ(summary["lines"], 1);
  const double radius_m = 0.3 * kContourMetresPerDegree;
  EXPECT_NEAR(summary["length_m"].get<double>(), 2 * std::numbers::pi * radius_m,
              0.005 * 2 * std::numbers::pi * radius_m);
}

TEST_F(ContourCommand, SimplifiedLinesHaveFewerPoints) {
  const std::string planet = cone("cone");
  const Words box{"--box", "9.6,-0.4,10.4,0.4", "--interval", "250", "--spacing", "200"};
  const auto with = [&](const char* metres) {
    Words words = box;
    words.insert(words.end(), {"--simplify", metres, "-o", path("s.geojson")});
    return contour(planet, words);
  };
  const json all = with("0");
  const json some = with("100");
  EXPECT_EQ(all["lines"], some["lines"]);
  EXPECT_LT(some["points"].get<int>() * 5, all["points"].get<int>());
  EXPECT_NEAR(some["length_m"].get<double>(), all["length_m"].get<double>(),
              0.01 * all["length_m"].get<double>());
}

TEST_F(ContourCommand, BothFormatsHaveTheSameLines) {
  const std::string planet = cone("cone");
  for (const char* name : {"a.geojson", "a.gpkg"})
    contour(planet, {"--box", "9.7,-0.3,10.3,0.3", "--interval", "300", "--spacing", "300", "-o", path(name)});
  const std::vector<ReadLine> json_lines = read("a.geojson");
  const std::vector<ReadLine> gpkg_lines = read("a.gpkg");
  ASSERT_EQ(json_lines.size(), gpkg_lines.size());
  for (std::size_t n = 0; n < json_lines.size(); ++n) {
    EXPECT_EQ(json_lines[n].elevation_m, gpkg_lines[n].elevation_m);
    ASSERT_EQ(json_lines[n].places.size(), gpkg_lines[n].places.size());
    for (std::size_t k = 0; k < json_lines[n].places.size(); ++k)
      EXPECT_NEAR(json_lines[n].places[k].first, gpkg_lines[n].places[k].first, 1e-9);
  }
}

TEST_F(ContourCommand, NodataHasNoLines) {
  const json summary = contour(cone("gap", -9999.0), {"--box", "9.6,-0.4,10.4,0.4", "--interval", "250",
                                                      "--spacing", "300", "-o", path("gap.geojson")});
  EXPECT_NEAR(summary["nodata_share"].get<double>(), 0.375, 0.02);
  for (const ReadLine& line : read("gap.geojson"))
    for (const auto& [lon, lat] : line.places) EXPECT_LT(lon, 10.1 + 0.01);
}

TEST_F(ContourCommand, GoesOverThePoleAndTheAntimeridian) {
  const json cap = contour(planet().string(), {"--box", "-180,60,180,90", "--interval", "500", "--spacing",
                                               "30000", "-o", path("cap.geojson")});
  EXPECT_GT(cap["lines"].get<int>(), 5);
  const json across = contour(planet().string(), {"--box", "170,-20,-170,20", "--interval", "500", "--spacing",
                                                  "30000", "-o", path("across.geojson")});
  EXPECT_GT(across["lines"].get<int>(), 2);
  for (const ReadLine& line : read("across.geojson"))
    for (const auto& [lon, lat] : line.places) {
      EXPECT_GE(std::abs(lon), 170 - 1e-9);
      EXPECT_LE(std::abs(lat), 20 + 1e-9);
    }
}

TEST_F(ContourCommand, ThreadsDoNotShowAndFilesCanBeReplaced) {
  const Words words{"--box", "0,0,40,30", "--interval", "100", "--simplify", "5000", "-o", path("t.geojson")};
  Words one = words;
  one.insert(one.end(), {"--threads", "1"});
  contour(planet().string(), one);
  const std::string first = read_text(dir_ / "t.geojson");
  Words many = words;
  many.insert(many.end(), {"--threads", "5"});
  contour(planet().string(), many);
  EXPECT_EQ(first, read_text(dir_ / "t.geojson"));
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(ContourCommand, SaysWhatItIsMadeOf) {
  const Result result = vpe(
      {"contour", planet().string(), "--box", "0,0,40,30", "--interval", "500", "-o", path("d.geojson"), "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(says(result.out, {"contours:", "levels:", "grid:", "datum:", "resolution:", "error:", "source:",
                                "nodata:", "synthetic:"}));
  EXPECT_TRUE(says(read_text(dir_ / "d.geojson"), {"\"description\"", "vpe contour", "every 500 m",
                                                   "Heights count from", "Nodata", "Synthetic"}));
}

TEST_F(ContourCommand, RefusesBadInput) {
  const std::string p = planet().string();
  const std::string out = path("x.geojson");
  expect_failure({"contour", p, "--interval", "100", "-o", out}, 2, {"--box"});
  expect_failure({"contour", p, "--box", "0,0,1,1", "-o", out}, 2, {"--interval"});
  expect_failure({"contour", p, "--box", "0,0,1,1", "--interval", "100"}, 2, {"-o"});
  expect_failure({"contour", p, "--box", "0,0,1,1", "--interval", "0", "-o", out}, 2, {"--interval"});
  expect_failure({"contour", p, "--box", "0,0,1,1", "--interval", "nan", "-o", out}, 2, {"--interval"});
  expect_failure({"contour", p, "--box", "0,0,1", "--interval", "100", "-o", out}, 2, {"--box", "WEST,SOUTH"});
  expect_failure({"contour", p, "--box", "0,5,1,5", "--interval", "100", "-o", out}, 2, {"--box", "latitudes"});
  expect_failure({"contour", p, "--box", "0,0,500,1", "--interval", "100", "-o", out}, 2,
                 {"--box", "longitudes"});
  expect_failure({"contour", p, "--box", "0,0,1,1", "--interval", "100", "-o", path("x.shp")}, 2,
                 {"x.shp", ".gpkg"});
  expect_failure({"contour", p, "--box", "0,0,30,30", "--interval", "100", "--spacing", "10", "-o", out}, 2,
                 {"million", "--spacing"});
  expect_failure({"contour", p, "--box", "0,0,30,30", "--interval", "0.000001", "-o", out}, 1, {"interval"});
  expect_failure({"contour", "none.vpe", "--box", "0,0,1,1", "--interval", "100", "-o", out}, 1, {"none.vpe"});
  EXPECT_FALSE(exists("x.geojson"));
}

}  // namespace
}  // namespace app_test
