// Every kind of coordinate system of authority IAU_2015, in the formats that GDAL writes: where a pixel lies
// agrees with PROJ, which knows the axes by the code.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/iau_crs.h"
#include "mars/sources/source.h"
#include "tests/mars/pds_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

// Maps a place to the coordinates that a file of this code has: x and y of the map, or longitude and latitude, in
// the directions of the system's own axes.
class IauOracle {
 public:
  explicit IauOracle(int code) : context_(proj_context_create()) {
    crs_ = proj_create(context_, ("IAU_2015:" + std::to_string(code)).c_str());
    if (crs_ == nullptr) return;
    PJ* geodetic = proj_crs_get_geodetic_crs(context_, crs_);
    geographic_ = proj_get_type(crs_) != PJ_TYPE_PROJECTED_CRS;
    read_axes(geodetic);
    PJ* ellipsoid = proj_get_ellipsoid(context_, crs_);
    double a = 0;
    double b = 0;
    proj_ellipsoid_get_parameters(context_, ellipsoid, &a, &b, nullptr, nullptr);
    if (!centric_) scale_ = (b * b) / (a * a);
    proj_destroy(ellipsoid);
    if (!geographic_) project_ = proj_create_crs_to_crs_from_pj(context_, geodetic, crs_, nullptr, nullptr);
    proj_destroy(geodetic);
  }
  ~IauOracle() {
    proj_destroy(project_);
    proj_destroy(crs_);
    proj_context_destroy(context_);
  }
  IauOracle(const IauOracle&) = delete;
  IauOracle& operator=(const IauOracle&) = delete;

  bool exists() const { return crs_ != nullptr; }
  bool is_geographic() const { return geographic_; }
  bool is_plain() const { return lon_sign_ > 0 && scale_ == 1; }
  std::string wkt2() const { return proj_as_wkt(context_, crs_, PJ_WKT2_2019, nullptr); }

  glm::dvec2 map(mars::LonLat place) const {
    const double lon = lon_sign_ * place.lon_deg;
    const double rad = mars::kRadiansPerDegree;
    const double lat = std::atan(std::tan(place.lat_deg * rad) / scale_) / rad;
    if (geographic_) return {lon, lat};
    const PJ_COORD c =
        proj_trans(project_, PJ_FWD, lat_first_ ? proj_coord(lat, lon, 0, 0) : proj_coord(lon, lat, 0, 0));
    return {c.xy.x, c.xy.y};
  }

 private:
  void read_axes(PJ* geodetic) {
    PJ* system = proj_crs_get_coordinate_system(context_, geodetic);
    for (int i = 0; i < 2; ++i) {
      const char* name = nullptr;
      const char* direction = nullptr;
      proj_cs_get_axis_info(context_, system, i, &name, nullptr, &direction, nullptr, nullptr, nullptr,
                            nullptr);
      if (i == 0) lat_first_ = std::string(direction) == "north";
      if (std::string(direction) == "west") lon_sign_ = -1;
      if (std::string(name).find("lanetocentric") != std::string::npos) centric_ = true;
    }
    proj_destroy(system);
  }

  PJ_CONTEXT* context_;
  PJ* crs_ = nullptr;
  PJ* project_ = nullptr;
  bool geographic_ = false;
  bool centric_ = false;
  bool lat_first_ = false;
  double lon_sign_ = 1;
  double scale_ = 1;  // tan(planetocentric latitude) = scale tan(latitude of the system)
};

struct Extent {
  double west, east, south, north;  // planetocentric, longitudes to the east
};

// A region whose west longitudes are no latitudes.
constexpr Extent kFarEast{100, 140, 35, 60};
constexpr std::array kKinds{0, 10, 15, 20, 25, 30, 40, 50};  // degrees and projections, of which +1 is
                                                             // planetographic, +2 planetocentric
const std::vector<int> kSixBodies{19900, 29900, 30100, 40100, 49900, 200000400};

class IauCrs : public ::testing::Test {
 protected:
  // Makes a raster of an extent as gdal_translate -a_srs -a_ullr does, and compares the places of its pixels.
  void compare(int code, const std::string& format, const Extent& extent) {
    const IauOracle oracle(code);
    ASSERT_TRUE(oracle.exists()) << code;
    glm::dvec2 low(1e300);
    glm::dvec2 high(-1e300);
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) {
        const glm::dvec2 xy = oracle.map({extent.west + (extent.east - extent.west) * i / 20,
                                          extent.south + (extent.north - extent.south) * j / 20});
        low = glm::min(low, xy);
        high = glm::max(high, xy);
      }
    }
    const glm::dvec2 step((high.x - low.x) / 60, (high.y - low.y) / 40);
    const std::string path = write(code, format, oracle, {low.x, step.x, 0, high.y, 0, -step.y});
    ASSERT_NE(path, "");
    const mars::GdalRaster raster(path);
    test_support::Random random(7);
    for (int i = 0; i < 60; ++i) {
      const mars::LonLat place{random.uniform(extent.west, extent.east),
                               random.uniform(extent.south, extent.north)};
      const glm::dvec2 xy = oracle.map(place);
      const glm::dvec2 ours = pds_files::pixel_of(raster, place);
      EXPECT_NEAR(ours.x, (xy.x - low.x) / step.x - 0.5, 1e-4) << place.lon_deg << " " << place.lat_deg;
      EXPECT_NEAR(ours.y, (high.y - xy.y) / step.y - 0.5, 1e-4) << place.lon_deg << " " << place.lat_deg;
    }
  }

  // Compares every kind that PROJ has of some bodies, in some formats. Returns how many these are.
  int compare_kinds(const std::vector<int>& bodies, const std::vector<std::string>& formats) {
    int compared = 0;
    for (const int body : bodies) {
      for (const int kind : kKinds) {
        for (const int latitudes : {0, 1, 2}) {
          const int code = body + kind + latitudes;
          if (!IauOracle(code).exists()) continue;
          for (const std::string& format : formats) {
            SCOPED_TRACE(std::to_string(code) + " " + format);
            compare(code, format, kFarEast);
            ++compared;
          }
        }
      }
    }
    return compared;
  }

  std::string write(int code, const std::string& format, const IauOracle& oracle,
                    std::array<double, 6> to_map) const {
    GDALAllRegister();
    auto* memory = GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 60, 40, 1, GDT_Float32, nullptr);
    OGRSpatialReference crs;
    const std::string text = format == "WKT2" ? oracle.wkt2() : "IAU_2015:" + std::to_string(code);
    EXPECT_EQ(crs.SetFromUserInput(text.c_str()), OGRERR_NONE);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    memory->SetSpatialRef(&crs);
    memory->SetGeoTransform(to_map.data());
    const std::string driver = format == "WKT2" ? "VRT" : format;
    const std::string path = (folder_ / ("r" + std::to_string(code) +
                                         (driver == "GTiff"  ? ".tif"
                                          : driver == "PDS4" ? ".xml"
                                                             : ".vrt")))
                                 .string();
    GDALDataset* source = memory;
    GDALDataset* pixels = nullptr;
    if (driver == "VRT") {
      pixels = GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
          (folder_ / "pixels.tif").string().c_str(), memory, FALSE, nullptr, nullptr, nullptr);
      GDALClose(pixels);
      pixels = GDALDataset::FromHandle(GDALOpen((folder_ / "pixels.tif").string().c_str(), GA_ReadOnly));
      source = pixels;
    }
    CPLPushErrorHandler(CPLQuietErrorHandler);
    auto* made = GetGDALDriverManager()
                     ->GetDriverByName(driver.c_str())
                     ->CreateCopy(path.c_str(), source, FALSE, nullptr, nullptr, nullptr);
    if (made != nullptr && driver == "VRT") made->SetSpatialRef(&crs);
    CPLPopErrorHandler();
    const bool done = made != nullptr;
    if (done) GDALClose(made);
    if (pixels != nullptr) GDALClose(pixels);
    GDALClose(memory);
    return done ? path : "";
  }

  test_support::TempDir folder_;
};

TEST_F(IauCrs, AllKindsOfSixBodiesAgreeWithProj) {
  // All of Mercury and Mars, the spheres of the others.
  EXPECT_EQ(compare_kinds(kSixBodies, {"GTiff"}), 8 * (3 + 3 + 1 + 1 + 1 + 1));
}

TEST_F(IauCrs, AllKindsOfMarsAgreeWithProjInEveryFormat) {
  EXPECT_EQ(compare_kinds({49900}, {"VRT", "WKT2"}), 2 * 8 * 3);
}

using LongIauCrs = IauCrs;

TEST_F(LongIauCrs, AllKindsOfSixBodiesAgreeWithProjInEveryFormat) {
  EXPECT_EQ(compare_kinds(kSixBodies, {"GTiff", "VRT", "WKT2"}), 3 * 8 * (3 + 3 + 1 + 1 + 1 + 1));
}

// GDAL writes all PDS4 labels as planetocentric with longitudes to the east.
TEST_F(IauCrs, Pds4OfSpheresAgreesWithProj) {
  for (const int body : kSixBodies) {
    for (const int kind : {0, 10, 20, 30}) {
      SCOPED_TRACE(body + kind);
      compare(body + kind, "PDS4", kFarEast);
    }
  }
}

// Near the prime meridian both orders are possible: a GeoTIFF has the longitude along its columns, as its standard
// says.
TEST_F(IauCrs, WestDegreesOfATiffNearThePrimeMeridian) { compare(49901, "GTiff", {-20, 20, 30, 60}); }

TEST_F(IauCrs, WestDegreesOfTheWholePlanet) {
  for (const char* format : {"GTiff", "VRT", "WKT2"}) {
    SCOPED_TRACE(format);
    compare(49901, format, {-180, 180, -90, 90});
  }
}

// Names and codes are those of PROJ's own list.
TEST(IauNames, HaveTheirCodes) {
  EXPECT_EQ(mars::plain_crs_name("Mars (2015) / Ographic"), "Mars_2015_Ographic");
  EXPECT_EQ(mars::plain_crs_name("Mars (2015) - Sphere / Ocentric"), "Mars_2015_Sphere_Ocentric");
  EXPECT_EQ(mars::plain_crs_name("__a--b__"), "a_b");
  EXPECT_EQ(mars::plain_crs_name(""), "");
  const mars::GdalScope scope;
  PJ_CONTEXT* context = proj_context_create();
  for (const char* code : {"49900", "49901", "49902", "49910", "30100", "19900"}) {
    PJ* crs = proj_create(context, ("IAU_2015:" + std::string(code)).c_str());
    ASSERT_NE(crs, nullptr) << code;
    EXPECT_EQ(mars::iau_code(mars::plain_crs_name(proj_get_name(crs))), code);
    proj_destroy(crs);
  }
  proj_context_destroy(context);
  EXPECT_FALSE(mars::iau_code("Vulcan_2015_Ographic"));
  EXPECT_FALSE(mars::iau_code(""));
}

// Other bodies and projections that only have such a name stay as they are.
TEST_F(IauCrs, ANameAloneRestoresNothing) {
  source_files::Raster raster;
  raster.width = raster.height = 4;
  raster.geotransform = source_files::box(10, 14, 14, 10, 4, 4);
  raster.crs =
      "GEOGCS[\"Mars (2015) / Ographic\",DATUM[\"d\",SPHEROID[\"s\",1737400,0]],PRIMEM[\"m\",0],"
      "UNIT[\"degree\",0.0174532925199433]]";
  const mars::GdalRaster opened(source_files::write(folder_ / "n.tif", raster));
  EXPECT_NEAR(pds_files::pixel_of(opened, {11.5, 11.5}).x, 1, 1e-6);
}

}  // namespace
