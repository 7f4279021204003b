// Coordinates of every kind of system become the places that PROJ says, whatever file format holds them.
#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/vector/feature_reader.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/support.h"

namespace {

using vector_files::collection;
using vector_files::expect_words;
using vector_files::feature;
using vector_files::read;
using vector_files::read_error;
using vector_files::translate;
using vector_files::vertices;
using vector_files::write_text;

// Maps planetocentric places to coordinates of a system of IAU_2015 with PROJ alone.
class ProjSystem {
 public:
  explicit ProjSystem(int code) : context_(proj_context_create()) {
    crs_ = proj_create(context_, ("IAU_2015:" + std::to_string(code)).c_str());
    if (crs_ == nullptr) return;
    PJ* geodetic = proj_crs_get_geodetic_crs(context_, crs_);
    PJ* axes = proj_crs_get_coordinate_system(context_, geodetic);
    bool is_centric = false;
    for (int i = 0; i < 2; ++i) {
      const char* name = nullptr;
      const char* direction = nullptr;
      proj_cs_get_axis_info(context_, axes, i, &name, nullptr, &direction, nullptr, nullptr, nullptr, nullptr);
      if (i == 0) lat_first_ = std::string(direction) == "north";
      if (std::string(direction) == "west") lon_sign_ = -1;
      if (std::string(name).find("lanetocentric") != std::string::npos) is_centric = true;
    }
    PJ* ellipsoid = proj_get_ellipsoid(context_, crs_);
    double a = 0;
    double b = 0;
    proj_ellipsoid_get_parameters(context_, ellipsoid, &a, &b, nullptr, nullptr);
    if (!is_centric) scale_ = (b * b) / (a * a);
    if (proj_get_type(crs_) == PJ_TYPE_PROJECTED_CRS)
      project_ = proj_create_crs_to_crs_from_pj(context_, geodetic, crs_, nullptr, nullptr);
    proj_destroy(ellipsoid);
    proj_destroy(axes);
    proj_destroy(geodetic);
  }
  ~ProjSystem() {
    proj_destroy(project_);
    proj_destroy(crs_);
    proj_context_destroy(context_);
  }
  ProjSystem(const ProjSystem&) = delete;
  ProjSystem& operator=(const ProjSystem&) = delete;

  bool exists() const { return crs_ != nullptr; }
  bool is_projected() const { return project_ != nullptr; }
  bool counts_west() const { return lon_sign_ < 0; }

  // Longitude first.
  glm::dvec2 map(glm::dvec2 place) const {
    const double lon = lon_sign_ * place.x;
    const double lat =
        std::abs(place.y) == 90
            ? place.y
            : std::atan(std::tan(place.y * mars::kRadiansPerDegree) / scale_) / mars::kRadiansPerDegree;
    if (project_ == nullptr) return {lon, lat};
    const PJ_COORD c =
        proj_trans(project_, PJ_FWD, lat_first_ ? proj_coord(lat, lon, 0, 0) : proj_coord(lon, lat, 0, 0));
    return {c.xy.x, c.xy.y};
  }

 private:
  PJ_CONTEXT* context_;
  PJ* crs_ = nullptr;
  PJ* project_ = nullptr;
  double lon_sign_ = 1;
  double scale_ = 1;
  bool lat_first_ = false;
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string points(const std::vector<glm::dvec2>& coordinates) {
  std::string text = R"({"type":"MultiPoint","coordinates":[)";
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    text += (i == 0 ? "[" : ",[") + number(coordinates[i].x) + "," + number(coordinates[i].y) + "]";
  return text + "]}";
}

// Returns the degrees by which places differ, on the sphere.
double off_deg(glm::dvec2 a, glm::dvec2 b) {
  return mars::distance_rad({a.x, a.y}, {b.x, b.y}) / mars::kRadiansPerDegree;
}

class VectorCrs : public ::testing::Test {
 protected:
  std::filesystem::path raw(const std::vector<glm::dvec2>& coordinates) const {
    write_text(folder_ / "raw.json", collection({feature(points(coordinates))}));
    return folder_ / "raw.json";
  }

  void expect_places(const std::filesystem::path& path, const std::vector<glm::dvec2>& places,
                     const mars::FeatureReadOptions& options = {}) const {
    const auto layers = read(path, options);
    ASSERT_EQ(layers.size(), 1U);
    const auto got = vertices(layers[0]);
    ASSERT_EQ(got.size(), places.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      EXPECT_LT(off_deg(got[i], places[i]), 1e-9) << i << ": " << got[i].x << " " << got[i].y;
      EXPECT_LE(std::abs(got[i].x), 180);
    }
  }

  test_support::TempDir folder_;
};

const std::vector<glm::dvec2> kPlaces{{137.4417, -4.5895}, {-133.8, 18.65}, {0, 0},       {179.5, 60},
                                      {-179.5, -60},       {77.5, 18.4},    {-120, 84.5}, {12.25, -88}};

TEST_F(VectorCrs, SystemsOfTheIauInAllFormats) {
  // Geographic on a sphere and on an ellipsoid, equirectangular, sinusoidal, polar stereographic, transverse Mercator.
  for (const int code : {49900, 49901, 49902, 49910, 49911, 49912, 49915, 49920, 49930, 49935, 49940}) {
    const ProjSystem system(code);
    ASSERT_TRUE(system.exists()) << code;
    std::vector<glm::dvec2> places;
    std::vector<glm::dvec2> coordinates;
    for (const glm::dvec2 place : kPlaces) {
      const bool is_far = code == 49930 ? place.y < 0 : code == 49935 ? place.y > 0 : std::abs(place.x) > 60;
      const bool is_local = code == 49930 || code == 49935 || code == 49940;
      if (is_local && is_far) continue;
      const glm::dvec2 p = system.map(place);
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      places.push_back(place);
      coordinates.push_back(p);
    }
    ASSERT_GE(places.size(), 2U) << code;
    const std::string name = "IAU_2015:" + std::to_string(code);
    for (const auto& [driver, file] : {std::pair{"GPKG", "a.gpkg"}, std::pair{"ESRI Shapefile", "a.shp"}}) {
      SCOPED_TRACE(name + " in " + file);
      std::filesystem::remove(folder_ / file);
      ASSERT_TRUE(translate(raw(coordinates), folder_ / file, {"-f", driver, "-a_srs", name, "-overwrite"}));
      expect_places(folder_ / file, places);
    }
    SCOPED_TRACE(name + " in GeoJSON");
    write_text(folder_ / "a.json",
               collection({feature(points(coordinates))}, "urn:ogc:def:crs:IAU_2015::" + std::to_string(code)));
    expect_places(folder_ / "a.json", places);
  }
}

TEST_F(VectorCrs, WestLongitudesInEitherOrder) {
  const std::vector<glm::dvec2> places{{137.4417, -4.5895}, {-133.8, 18.65}};
  const ProjSystem system(49901);
  std::vector<glm::dvec2> lon_first;
  std::vector<glm::dvec2> lat_first;
  for (const glm::dvec2 place : places) {
    lon_first.push_back(system.map(place));
    lat_first.emplace_back(lon_first.back().y, lon_first.back().x);
  }
  for (const auto& coordinates : {lon_first, lat_first}) {
    ASSERT_TRUE(translate(raw(coordinates), folder_ / "w.gpkg", {"-f", "GPKG", "-a_srs", "IAU_2015:49901"}));
    expect_places(folder_ / "w.gpkg", places);
    std::filesystem::remove(folder_ / "w.gpkg");
  }
  // Near the prime meridian both may be latitudes.
  ASSERT_TRUE(translate(raw({{5, 2}}), folder_ / "near.gpkg", {"-f", "GPKG", "-a_srs", "IAU_2015:49901"}));
  expect_words(read_error(folder_ / "near.gpkg"),
               {"near.gpkg", "both of its coordinates may be latitudes", "49900"});
  mars::FeatureReadOptions options;
  options.axis_order = mars::AxisOrder::lon_first;
  const double lat = mars::sin_cos_deg(2).sin / mars::sin_cos_deg(2).cos * std::pow(3376200.0 / 3396190, 2);
  expect_places(folder_ / "near.gpkg", {{-5, std::atan(lat) / mars::kRadiansPerDegree}}, options);
}

TEST_F(VectorCrs, DegreesOfWgs84AreThoseOfThePlanet) {
  const std::vector<glm::dvec2> places{{137.4417, -4.5895}, {-133.8, 80}};
  expect_places(raw(places), places);
  ASSERT_TRUE(translate(raw(places), folder_ / "a.gpkg", {"-f", "GPKG", "-a_srs", "EPSG:4326"}));
  expect_places(folder_ / "a.gpkg", places);
  ASSERT_TRUE(translate(raw(places), folder_ / "a.shp", {"-f", "ESRI Shapefile", "-a_srs", "EPSG:4326"}));
  expect_places(folder_ / "a.shp", places);
  std::filesystem::remove(folder_ / "a.prj");
  expect_places(folder_ / "a.shp", places);
}

TEST_F(VectorCrs, DegreesOfWgs84OnTheEarthAreGeodetic) {
  const auto layers = mars::read_features(raw({{10, 45}}).string(), {}, 6'371'008.8);
  const double f = 1 / 298.257223563;
  const glm::dvec2 expected(10, std::atan((1 - f) * (1 - f)) / mars::kRadiansPerDegree);
  EXPECT_LT(off_deg(vertices(layers.at(0)).at(0), expected), 1e-9);
}

TEST_F(VectorCrs, LongitudesFrom0To360OfAShapefile) {
  ASSERT_TRUE(translate(raw({{350, 10}, {137.4, -4.5}, {180, 0}, {360, 1}}), folder_ / "a.shp",
                        {"-f", "ESRI Shapefile", "-a_srs", "+proj=longlat +R=3396190 +no_defs"}));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.prj"));
  expect_places(folder_ / "a.shp", {{-10, 10}, {137.4, -4.5}, {180, 0}, {0, 1}});
}

TEST_F(VectorCrs, OtherMeridiansAndUnits) {
  const std::string degrees =
      R"(GEOGCS["x",DATUM["d",SPHEROID["s",3396190,0]],PRIMEM["airy",10],UNIT["degree",0.0174532925199433]])";
  ASSERT_TRUE(translate(raw({{100, 50}}), folder_ / "a.gpkg", {"-f", "GPKG", "-a_srs", degrees}));
  expect_places(folder_ / "a.gpkg", {{110, 50}});
  const std::string grads =
      R"(GEOGCS["x",DATUM["d",SPHEROID["s",3396190,0]],PRIMEM["airy",0],UNIT["grad",0.01570796326794897]])";
  ASSERT_TRUE(translate(raw({{100, 50}}), folder_ / "b.gpkg", {"-f", "GPKG", "-a_srs", grads}));
  expect_places(folder_ / "b.gpkg", {{90, 45}});
  const double per_degree = 3396.190 * mars::kRadiansPerDegree;
  ASSERT_TRUE(translate(raw({{per_degree * 30, per_degree * 20}}), folder_ / "c.gpkg",
                        {"-f", "GPKG", "-a_srs", "+proj=eqc +R=3396190 +lon_0=180 +units=km +no_defs"}));
  expect_places(folder_ / "c.gpkg", {{-150, 20}});
}

TEST_F(VectorCrs, OtherBodiesAreRefused) {
  ASSERT_TRUE(translate(raw({{10, 20}}), folder_ / "moon.gpkg", {"-f", "GPKG", "-a_srs", "IAU_2015:30100"}));
  expect_words(read_error(folder_ / "moon.gpkg"),
               {"moon.gpkg", "layer 'raw'", "Moon", "1737.4", "Mars", "3396.19"});
  ASSERT_TRUE(translate(raw({{500000, 20}}), folder_ / "utm.gpkg", {"-f", "GPKG", "-a_srs", "EPSG:32633"}));
  expect_words(read_error(folder_ / "utm.gpkg"), {"UTM zone 33N", "Earth", "Mars"});
  ASSERT_TRUE(translate(raw({{10, 20}}), folder_ / "nad.gpkg", {"-f", "GPKG", "-a_srs", "EPSG:4267"}));
  expect_words(read_error(folder_ / "nad.gpkg"), {"NAD27", "Earth"});
  const auto on_moon = mars::read_features((folder_ / "moon.gpkg").string(), {}, 1'737'400);
  EXPECT_EQ(vertices(on_moon.at(0)).size(), 1U);
}

TEST_F(VectorCrs, UnknownSystemsAreRefused) {
  write_text(folder_ / "n.json", collection({feature(points({{10, 20}}))}, "nonsense"));
  expect_words(read_error(folder_ / "n.json"), {"n.json", "crs", "nonsense"});
  write_text(folder_ / "f.json", collection({feature(points({{10, 20}}))}, "/etc/hostname"));
  expect_words(read_error(folder_ / "f.json"), {"f.json", "crs", "/etc/hostname"});
  ASSERT_TRUE(translate(raw({{10, 20}}), folder_ / "a.shp", {"-f", "ESRI Shapefile", "-a_srs", "EPSG:4326"}));
  write_text(folder_ / "a.prj", "what is this");
  expect_words(read_error(folder_ / "a.shp"), {"a.shp", "a.prj", "remove it if coordinates are degrees"});
  ASSERT_TRUE(
      translate(raw({{10, 20}}), folder_ / "local.gpkg", {"-f", "GPKG", "-a_srs", "LOCAL_CS[\"plan\"]"}));
  expect_words(read_error(folder_ / "local.gpkg"), {"local.gpkg", "no places on a planet"});
  // Metres without a system.
  expect_words(read_error(raw({{500000, 20}})), {"is no place", "metres", "-a_srs"});
}

}  // namespace
