// One region made in each coordinate system gives the same planet: every raster holds exact values of one
// formula at its own pixels' places (by PROJ, which shares no code with GDAL's CRS classes), and all are
// sampled at the same places.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/sources/source.h"
#include "tests/mars/pds_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::Proj;

constexpr double kRadian = mars::kRadiansPerDegree;

// Without symmetry that could hide a mirrored planet; second derivatives along great circles below kCurvature.
constexpr double kEdges = 20000;
double relief(const glm::dvec3& d) {
  return 3000 * d.z + 2000 * d.x - 1000 * d.y + 1500 * d.x * d.y + 800 * d.z * d.y + 2500 * d.x * d.x * d.z;
}

struct Region {
  const char* name;
  double west, east, south, north;
};
const Region kGale{"Gale", 130, 146, -12, 4};
const Region kDateLine{"DateLine", 168, 196, 58, 72};
const Region kPrimeMeridian{"PrimeMeridian", -9, 14, -33, -18};

struct Case {
  const char* name;
  const char* crs;  // of the file
  const char*
      proj;  // for PROJ: degrees (latitude of the CRS's own kind) to metres; nullptr: degrees themselves
  double a = 3396190;      // of the body
  double inverse_f = 0;    // 0: a sphere
  bool x_to_west = false;  // the file's first coordinate grows to the west
  double lon_shift = 0;    // for degrees: the turn that the file's longitudes are in
  const char* driver = "VRT";
  bool centric = false;    // latitudes of an ellipsoid's CRS are planetocentric
  bool lat_first = false;  // columns run along the latitude
};

constexpr double kMarsF = 169.894447223612;
constexpr double kEarthF = 298.257223563;
#define MARS " +R=3396190"
#define FLAT " +a=3396190 +rf=169.894447223612"
const Case kCases[] = {
    {"Degrees", "IAU_2015:49900", nullptr},
    {"DegreesFrom0To360", "IAU_2015:49900", nullptr, 3396190, 0, false, 360},
    {"DegreesBelowMinus180", "+proj=longlat" MARS, nullptr, 3396190, 0, false, -360},
    // What gdalwarp -t_srs IAU_2015:49901 makes: GDAL knows no order but that of the CRS where longitudes count
    // west.
    {"PlanetographicWestDegrees", "IAU_2015:49901", nullptr, 3396190, kMarsF, true, 0, "VRT", false, true},
    {"PlanetocentricOnEllipsoid", "IAU_2015:49902", nullptr, 3396190, kMarsF, false, 0, "VRT", true},
    {"Equirectangular", "IAU_2015:49910", "+proj=eqc" MARS},
    {"EquirectangularWest", "IAU_2015:49911", "+proj=eqc" FLAT, 3396190, kMarsF, true},
    {"EquirectangularAt180", "IAU_2015:49915", "+proj=eqc +lon_0=180" MARS},
    {"EquirectangularAt180West", "IAU_2015:49916", "+proj=eqc +lon_0=180" FLAT, 3396190, kMarsF, true},
    {"EquirectangularAnywhere", "+proj=eqc +lat_ts=-35 +lon_0=137.31 +x_0=5000 +y_0=-70" MARS,
     "+proj=eqc +lat_ts=-35 +lon_0=137.31 +x_0=5000 +y_0=-70" MARS},
    {"Sinusoidal", "IAU_2015:49920", "+proj=sinu" MARS},
    {"SinusoidalWest", "IAU_2015:49921", "+proj=sinu" FLAT, 3396190, kMarsF, true},
    {"SinusoidalAt180", "IAU_2015:49925", "+proj=sinu +lon_0=180" MARS},
    {"SinusoidalAt200", "+proj=sinu +lon_0=200" MARS, "+proj=sinu +lon_0=200" MARS},
    {"NorthPolar", "IAU_2015:49930", "+proj=stere +lat_0=90" MARS},
    {"NorthPolarWest", "IAU_2015:49931", "+proj=stere +lat_0=90" FLAT, 3396190, kMarsF, true},
    {"SouthPolarTurned", "+proj=stere +lat_0=-90 +lat_ts=-71 +lon_0=77" FLAT,
     "+proj=stere +lat_0=-90 +lat_ts=-71 +lon_0=77" FLAT, 3396190, kMarsF},
    {"Mercator", "+proj=merc +lat_ts=20 +lon_0=150" FLAT, "+proj=merc +lat_ts=20 +lon_0=150" FLAT, 3396190,
     kMarsF},
    {"LambertAzimuthal", "+proj=laea +lat_0=20 +lon_0=160" MARS, "+proj=laea +lat_0=20 +lon_0=160" MARS},
    {"Moon", "IAU_2015:30110", "+proj=eqc +R=1737400", 1737400},
    {"MoonSinusoidalTiff", "+proj=sinu +lon_0=150 +R=1737400", "+proj=sinu +lon_0=150 +R=1737400", 1737400, 0,
     false, 0, "GTiff"},
    {"VestaTiff", "+proj=eqc +lon_0=180 +a=285000 +b=229000", "+proj=eqc +lon_0=180 +a=285000 +b=229000",
     285000, 285.0 / 56.0, false, 0, "GTiff"},
    {"EarthGeodeticDegrees", "EPSG:4326", nullptr, 6378137, kEarthF, false, 0, "GTiff"},
    {"EarthPolar", "EPSG:3413", "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45 +ellps=WGS84", 6378137, kEarthF,
     false, 0, "GTiff"},
    {"EarthUtmEnvi", "EPSG:32653", "+proj=tmerc +lon_0=135 +k=0.9996 +x_0=500000 +ellps=WGS84", 6378137,
     kEarthF, false, 0, "ENVI"},
};
#undef MARS
#undef FLAT

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

class SamePlanet : public ::testing::TestWithParam<Case> {
 protected:
  static double centric_scale() {
    const Case& w = GetParam();
    if (w.centric || w.inverse_f == 0) return 1;
    return (1 - 1 / w.inverse_f) * (1 - 1 / w.inverse_f);
  }
  static glm::dvec3 direction(mars::LonLat own) {
    const mars::SinCos lat = mars::sin_cos_deg(own.lat_deg);
    const mars::SinCos lon = mars::sin_cos_deg(own.lon_deg);
    return glm::normalize(glm::dvec3(lat.cos * lon.cos, lat.cos * lon.sin, lat.sin * centric_scale()));
  }
  static double own_lat(double centric_deg) {
    return std::atan(std::tan(centric_deg * kRadian) / centric_scale()) / kRadian;
  }

  // The file's coordinates of an east longitude and planetocentric latitude, and back.
  glm::dvec2 map(mars::LonLat place) const {
    const mars::LonLat own{place.lon_deg, own_lat(place.lat_deg)};
    glm::dvec2 xy = proj_ ? proj_->forward(own) : glm::dvec2(own.lon_deg + GetParam().lon_shift, own.lat_deg);
    if (GetParam().x_to_west) xy.x = -xy.x;
    if (GetParam().lat_first) std::swap(xy.x, xy.y);
    return xy;
  }
  glm::dvec3 direction_at(glm::dvec2 xy) const {
    if (GetParam().lat_first) std::swap(xy.x, xy.y);
    if (GetParam().x_to_west) xy.x = -xy.x;
    return direction(proj_ ? proj_->inverse(xy) : mars::LonLat{xy.x - GetParam().lon_shift, xy.y});
  }

  void SetUp() override {
    if (GetParam().proj != nullptr) proj_.emplace(GetParam().proj);
  }

  void compare(const Region& region) {
    // A raster that covers the region, 120 pixels along its longer side.
    glm::dvec2 low(1e300);
    glm::dvec2 high(-1e300);
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const glm::dvec2 xy = map({region.west + (region.east - region.west) * i / 40,
                                   region.south + (region.north - region.south) * j / 40});
        low = glm::min(low, xy);
        high = glm::max(high, xy);
      }
    }
    const double step = std::max(high.x - low.x, high.y - low.y) / 120;
    low -= 2 * step;
    high += 2 * step;
    source_files::Raster raster;
    raster.width = static_cast<int>((high.x - low.x) / step) + 1;
    raster.height = static_cast<int>((high.y - low.y) / step) + 1;
    raster.type = GDT_Float64;
    raster.crs = GetParam().crs;
    raster.geotransform = std::array<double, 6>{low.x, step, 0, high.y, 0, -step};
    const auto at_pixel = [&](double column, double row) {
      return direction_at({low.x + (column + 0.5) * step, high.y - (row + 0.5) * step});
    };
    raster.value = [&](int, int column, int row) { return relief(at_pixel(column, row)); };
    const std::string path = write(raster);
    const auto source = mars::open_elevation(path);
    std::optional<mars::GdalRaster> opened;
    if (&region == &kGale) opened.emplace(path);

    test_support::Random random(99);
    for (int i = 0; i < 150; ++i) {
      const mars::LonLat place{random.uniform(region.west, region.east),
                               random.uniform(region.south, region.north)};
      const glm::dvec2 xy = map(place);
      const glm::dvec2 pixel((xy.x - low.x) / step - 0.5, (high.y - xy.y) / step - 0.5);
      if (opened) {
        const glm::dvec2 ours = pds_files::pixel_of(*opened, place);
        EXPECT_NEAR(ours.x, pixel.x, 2e-5) << place.lon_deg << " " << place.lat_deg;
        EXPECT_NEAR(ours.y, pixel.y, 2e-5) << place.lon_deg << " " << place.lat_deg;
      }
      // Bilinear interpolation is off by the curvature over a pixel's diagonals on the ground.
      const double h = std::max(glm::distance(at_pixel(pixel.x, pixel.y), at_pixel(pixel.x + 1, pixel.y + 1)),
                                glm::distance(at_pixel(pixel.x + 1, pixel.y), at_pixel(pixel.x, pixel.y + 1)));
      const glm::dvec3 d = mars::direction(place);
      EXPECT_NEAR(source_files::height_at(*source, place), relief(d), kEdges * h * h / 4 + 1e-4) << region.name;
    }
  }

  std::string write(source_files::Raster raster) const {
    const std::string driver = GetParam().driver;
    if (driver != "VRT") {
      raster.driver = driver;
      return source_files::write(folder_ / (driver == "ENVI" ? "r.dat" : "r.tif"), raster);
    }
    // A VRT keeps any CRS as it is.
    std::ostringstream text;
    text << std::setprecision(17) << "<VRTDataset rasterXSize=\"" << raster.width << "\" rasterYSize=\""
         << raster.height << "\"><SRS>" << raster.crs << "</SRS><GeoTransform>";
    for (int i = 0; i < 6; ++i)
      text << (i > 0 ? "," : "") << (*raster.geotransform)[static_cast<std::size_t>(i)];
    text << "</GeoTransform><VRTRasterBand dataType=\"Float64\" band=\"1\"><SimpleSource><SourceFilename "
            "relativeToVRT=\"1\">raw.dat</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
    raster.crs.clear();
    raster.geotransform.reset();
    raster.driver = "ENVI";
    source_files::write(folder_ / "raw.dat", raster);
    source_files::write_text(folder_ / "r.vrt", text.str());
    return (folder_ / "r.vrt").string();
  }

  std::optional<Proj> proj_;
  test_support::TempDir folder_;
};

TEST_P(SamePlanet, AtGale) { compare(kGale); }
TEST_P(SamePlanet, AcrossTheDateLine) {
  // Maps centred elsewhere have the date line at their two ends: such a region is no raster of theirs.
  const std::string name = GetParam().name;
  if (name == "Equirectangular" || name == "EquirectangularWest" || name == "EquirectangularAnywhere" ||
      name == "Sinusoidal" || name == "SinusoidalWest" || name == "Moon" || name == "MoonSinusoidalTiff" ||
      name == "Mercator" || name == "EarthUtmEnvi" || name == "SouthPolarTurned") {
    return;
  }
  compare(kDateLine);
}
TEST_P(SamePlanet, AcrossThePrimeMeridian) {
  const std::string name = GetParam().name;
  if (name.find("180") != std::string::npos || name == "SinusoidalAt200" || name == "EquirectangularAnywhere" ||
      name == "Mercator" || name == "MoonSinusoidalTiff" || name == "VestaTiff" || name == "EarthUtmEnvi" ||
      name == "LambertAzimuthal" || name == "EarthPolar") {
    return;
  }
  compare(kPrimeMeridian);
}

// Columns that can be no latitudes are longitudes, as gdal_translate -a_srs leaves them.
TEST(WestDegrees, WrittenByHandAreReadAndImpossibleAreRefused) {
  const test_support::TempDir folder;
  const auto write = [&](const char* geotransform) {
    source_files::write_text(
        folder / "h.vrt",
        std::string("<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><SRS>IAU_2015:49901</SRS><GeoTransform>") +
            geotransform + "</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>");
    return (folder / "h.vrt").string();
  };
  const mars::GdalRaster raster(write("-140,1,0,-2,0,-1"));
  const glm::dvec2 pixel = pds_files::pixel_of(raster, {138.5, -3});
  EXPECT_NEAR(pixel.x, 1, 1e-6);
  EXPECT_NEAR(pixel.y, 0.5, 0.05);  // graphic latitudes lie farther from the equator
  const std::string message = source_files::elevation_error(write("-140,1,0,-102,0,-1"));
  EXPECT_NE(message.find("lies nowhere on the planet"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(CoordinateSystems, SamePlanet, ::testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
