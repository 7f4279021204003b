// Elevation in many projections against one function of the place, with PROJ as oracle for where pixels lie.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::Proj;
using source_files::Raster;

// Smooth, without symmetry that could hide a swapped axis or a mirrored planet. Its second derivative along any
// great circle is at most kCurvature.
constexpr double kEdges = 20000;
double relief(const glm::dvec3& d) {
  return 3000 * d.z + 2000 * d.x - 1000 * d.y + 1500 * d.x * d.y + 800 * d.z * d.y + 2500 * d.x * d.x * d.z;
}

struct Map {
  const char* name;
  const char* crs;                  // for the file
  const char* proj;                 // for PROJ: degrees of latitude of the CRS's own kind
  double west, north, east, south;  // metres
  int width, height;
  double centric_scale = 1;  // tan(centric) = scale tan(latitude of the CRS)
  bool linear = false;
};

constexpr double kQuarter = 5334722.777;  // a quarter of Mars's circumference
constexpr double kFlattened = (1 - 1 / 169.894447223612) * (1 - 1 / 169.894447223612);
#define SPHERE "+R=3396190 +units=m +no_defs"
constexpr char kGraphic[] = "+proj=eqc +lat_ts=0 +lon_0=0 +a=3396190 +rf=169.894447223612 +units=m +no_defs";

const Map kMaps[] = {
    {"EquirectangularAt180", "+proj=eqc +lat_ts=0 +lat_0=0 +lon_0=180 " SPHERE, nullptr, -2 * kQuarter,
     kQuarter, 2 * kQuarter, -kQuarter, 720, 360, 1, true},
    {"EquirectangularTrueAt40", "+proj=eqc +lat_ts=40 +lat_0=0 +lon_0=70 " SPHERE, nullptr, -1e6, 2e6, 2e6,
     -1.5e6, 300, 350, 1, true},
    {"EllipsoidalEquirectangular", kGraphic, kGraphic, -2e6, 4e6, 3e6, -3e6, 500, 700, kFlattened, true},
    {"Sinusoidal", "+proj=sinu +lon_0=138 " SPHERE, nullptr, -3e6, 3e6, 3e6, -4e6, 600, 700},
    {"NorthPolarStereographic", "+proj=stere +lat_0=90 +lat_ts=90 +lon_0=0 " SPHERE, nullptr, -3e6, 3e6, 3e6,
     -3e6, 600, 600},
    {"SouthPolarStereographic", "+proj=stere +lat_0=-90 +lat_ts=-90 +lon_0=30 " SPHERE, nullptr, -2e6, 2.5e6,
     3e6, -3e6, 500, 550},
    {"Mercator", "+proj=merc +lon_0=180 " SPHERE, nullptr, -2 * kQuarter, 8e6, 2 * kQuarter, -8e6, 720, 540},
    {"Mollweide", "+proj=moll +lon_0=-60 " SPHERE, nullptr, -5e6, 4e6, 5e6, -4e6, 500, 400},
    {"Orthographic", "+proj=ortho +lat_0=20 +lon_0=77 " SPHERE, nullptr, -3e6, 3e6, 3e6, -3e6, 600, 600},
    {"TransverseMercator", "+proj=tmerc +lat_0=0 +lon_0=45 +k=0.9996 " SPHERE, nullptr, -8e5, 2e6, 8e5, -2e6,
     160, 400},
    {"LambertConformal", "+proj=lcc +lat_1=20 +lat_2=60 +lat_0=35 +lon_0=-100 " SPHERE, nullptr, -2e6, 2e6, 2e6,
     -1e6, 400, 300},
};
#undef SPHERE

void PrintTo(const Map& map, std::ostream* out) { *out << map.name; }

class Projection : public ::testing::TestWithParam<Map> {};

TEST_P(Projection, SamplesAgreeWithTheFunction) {
  const Map& m = GetParam();
  const test_support::TempDir folder;
  const Proj proj(m.proj != nullptr ? m.proj : m.crs);
  const double dx = (m.east - m.west) / m.width;
  const double dy = (m.south - m.north) / m.height;
  const auto centric = [&](mars::LonLat p) {
    const mars::SinCos lat = mars::sin_cos_deg(p.lat_deg);
    const mars::SinCos lon = mars::sin_cos_deg(p.lon_deg);
    return glm::normalize(glm::dvec3(lat.cos * lon.cos, lat.cos * lon.sin, lat.sin * m.centric_scale));
  };

  Raster raster;
  raster.width = m.width;
  raster.height = m.height;
  raster.type = GDT_Float64;
  raster.crs = m.crs;
  raster.geotransform = source_files::box(m.west, m.north, m.east, m.south, m.width, m.height);
  raster.nodata = -1e9;
  raster.value = [&](int, int column, int row) {
    const mars::LonLat place = proj.inverse({m.west + (column + 0.5) * dx, m.north + (row + 0.5) * dy});
    return mars::is_valid(place) ? relief(centric(place)) : -1e9;
  };
  const std::string path = source_files::write(folder / "map.tif", raster);
  const auto source = mars::open_elevation(path);
  EXPECT_EQ(mars::GdalRaster(path).georeference().is_linear(), m.linear);
  EXPECT_NEAR(source->infos().at(0).resolution_m, std::min(dx, -dy), 1e-6 * dx);

  test_support::Random random(2024);
  std::vector<glm::dvec3> directions;
  std::vector<double> tolerance_m;
  while (directions.size() < 4000) {
    const glm::dvec3 d = random.direction();
    // The latitude of the CRS's kind, for the oracle.
    const glm::dvec3 own = glm::normalize(glm::dvec3(d.x, d.y, d.z / m.centric_scale));
    const glm::dvec2 map = proj.forward(mars::lon_lat(own));
    const glm::dvec2 pixel((map.x - m.west) / dx - 0.5, (map.y - m.north) / dy - 0.5);
    if (!(pixel.x >= 0 && pixel.x <= m.width - 1 && pixel.y >= 0 && pixel.y <= m.height - 1)) continue;
    // The limb of an orthographic map and the rim of a sinusoidal one stretch a pixel without end.
    if (std::string(m.name) == "Orthographic" && glm::length(map) > 0.8 * 3396190) continue;
    // Half a pixel of misplacement would be thirty times this on the steep parts.
    const double pixel_rad = std::max(dx, -dy) / 3396190;
    directions.push_back(d);
    tolerance_m.push_back(kEdges * pixel_rad * pixel_rad / 8 * 4);
  }
  std::vector<double> heights_m(directions.size());
  source->sample(directions, 1, heights_m);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    EXPECT_NEAR(heights_m[i], relief(directions[i]), tolerance_m[i]) << mars::lon_lat(directions[i]).lat_deg;
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, Projection, ::testing::ValuesIn(kMaps),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
