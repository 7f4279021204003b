// Values of maps against those of query().
#include "vpe/map/map_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "mars/geodesy/sun.h"
#include "paging/surface/query.h"
#include "tests/paging/surface_fixture.h"

namespace {

using test_support::FakeElevation;
using vpe::map::MapBand;
using vpe::map::MapGrid;
using vpe::map::MapGround;
using vpe::map::MapLight;
using vpe::map::MapRows;
using vpe::map::MapSampler;

constexpr double kMars_m = 3396190;

// Bumps, with nodata in the middle of a face.
double bumps_with_a_hole(const glm::dvec3& d) {
  return glm::length(d - glm::normalize(glm::dvec3(0.1, 1, 0.2))) < 0.1 ? std::nan("")
                                                                        : test_support::bumpy_height(d);
}

class MapSamplerTest : public test_support::SurfaceTest<bumps_with_a_hole> {};

const std::vector<MapBand> kGroundBands{MapBand::elevation, MapBand::slope,         MapBand::aspect,
                                        MapBand::source,    MapBand::post_spacing,  MapBand::synthetic,
                                        MapBand::error,     MapBand::source_spacing};

bool same(float value, bool known, double expected) {
  return known ? value == static_cast<float>(expected) : std::isnan(value);
}

// Compares random pixels of a map with query(). Returns the number of pixels that differ.
int count_differences(const paging::Surface& surface, const std::string& system, const vpe::map::PlaceBox& box,
                      double spacing_m, int pixels, std::uint64_t seed) {
  const mars::MapCrs crs(system, kMars_m);
  const MapGrid grid = vpe::map::grid_of_box(crs, box, spacing_m);
  const MapSampler sampler(surface, nullptr, crs, grid, kGroundBands, {});
  test_support::Random random(seed);
  int wrong = 0;
  int seen = 0;
  const int rows_each = 8;
  const int per_block = 40;
  while (seen < pixels) {
    const int first = random.integer(0, std::max(0, grid.rows - rows_each));
    const int count = std::min(rows_each, grid.rows - first);
    MapGround ground;
    const MapRows rows = sampler.rows(first, count, ground);
    for (int k = 0; k < per_block * 10; ++k, ++seen) {
      const int column = random.integer(0, grid.columns - 1);
      const int row = random.integer(0, count - 1);
      const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                            static_cast<std::size_t>(column);
      std::vector<glm::dvec2> place{grid.middle(column, first + row)};
      crs.to_place(place);
      if (!std::isfinite(place[0].x)) {
        wrong += std::isnan(rows[0][i]) ? 0 : 1;
        continue;
      }
      const paging::PlaceAnswer a = paging::query(surface, {place[0].x, place[0].y});
      const bool known = !a.nodata;
      const bool good = same(rows[0][i], known, a.elevation_m) && same(rows[1][i], known, a.slope_deg) &&
                        same(rows[2][i], known, a.aspect_deg) &&
                        same(rows[3][i], a.source.has_value(), a.source.value_or(0)) &&
                        same(rows[4][i], known, a.spacing_m) && same(rows[5][i], a.source.has_value(), 0) &&
                        same(rows[6][i], a.resampling.posts > 0, a.resampling.max_m) &&
                        same(rows[7][i], a.source.has_value(), 1000);
      wrong += good ? 0 : 1;
    }
  }
  return wrong;
}

struct Case {
  const char* crs;
  vpe::map::PlaceBox box;
  double spacing_m;
};

// Over both poles, the antimeridian, the fine ground and the hole.
const std::vector<Case> kCases{
    {"IAU_2015:49900", {}, 60000},
    {"IAU_2015:49910", {150, -40, 210, 40}, 9000},
    {"IAU_2015:49915", {}, 40000},
    {"IAU_2015:49930", {-180, 40, 180, 90}, 15000},
    {"IAU_2015:49935", {-180, -90, 180, -50}, 15000},
    {"IAU_2015:49912", {-20, -20, 20, 20}, 3000},
    {"+proj=sinu +lon_0=90 +R=3396190", {}, 50000},
    {"+proj=ortho +lat_0=10 +lon_0=84 +R=3396190", {-180, -90, 180, 90}, 30000},
    {"+proj=laea +lat_0=90 +lon_0=0 +R=3396190", {-180, 0, 180, 90}, 30000},
    {"+proj=lcc +lat_1=10 +lat_2=50 +lon_0=-175 +R=3396190", {-205, 5, -145, 60}, 12000}};

TEST_F(MapSamplerTest, EqualsQueryAtEveryPixel) {
  std::uint64_t seed = 20261127;
  for (const Case& c : kCases)
    EXPECT_EQ(count_differences(*surface_, c.crs, c.box, c.spacing_m, 2000, ++seed), 0) << c.crs;
}

TEST_F(MapSamplerTest, CountsWhatLiesUnderThePixels) {
  const mars::MapCrs crs("+proj=ortho +lat_0=10 +lon_0=84 +R=3396190", kMars_m);
  const MapGrid grid = vpe::map::grid_of_box(crs, {}, 50000);
  const MapSampler sampler(*surface_, nullptr, crs, grid, {MapBand::elevation}, {});
  MapGround ground;
  const MapRows rows = sampler.rows(0, grid.rows, ground);
  std::int64_t finite = 0;
  for (const float value : rows[0]) finite += std::isfinite(value) ? 1 : 0;
  EXPECT_EQ(ground.pixels + ground.off_planet, std::int64_t{grid.rows} * grid.columns);
  EXPECT_EQ(finite, ground.pixels - ground.nodata);
  // A disc in a square.
  EXPECT_NEAR(static_cast<double>(ground.pixels) / (static_cast<double>(grid.rows) * grid.columns),
              std::numbers::pi / 4, 0.02);
  EXPECT_GT(ground.nodata, 0);
  EXPECT_EQ(ground.synthetic, 0);
  EXPECT_GT(ground.coarsest_spacing_m, 40000);
  EXPECT_EQ(ground.sources, std::set<int>{0});
  EXPECT_GE(ground.error_max_m, 0);
  MapGround twice = ground;
  twice.add(ground);
  EXPECT_EQ(twice.pixels, 2 * ground.pixels);
  EXPECT_EQ(twice.error_max_m, ground.error_max_m);
}

// A ridge along the meridian of 10 E, 3 km high and steep, on level ground.
double ridge(const glm::dvec3& d) {
  const double lon_deg = std::atan2(d.y, d.x) * 180 / std::numbers::pi;
  return 3000 * std::max(0.0, 1 - std::abs(lon_deg - 10) / 0.5);
}

TEST_F(MapSamplerTest, LightAndShadowOfARidge) {
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(
      dir / "r.vpe", FakeElevation(ridge, test_support::fine_around(mars::direction({10, 0}), 0.06, 3000)),
      60000);
  const paging::Surface surface(planet, 64 << 20);
  const mars::MapCrs crs("IAU_2015:49900", kMars_m);
  const MapGrid grid{7, 0.05, 0.1, 60, 1};
  MapLight light;
  // In the east, 3 degrees up: the shadow of the crest is 3000 / tan(3) = 57 km long, 0.97 degrees.
  light.sun = mars::sun_direction({10, 0}, 90, 3);
  const MapSampler sampler(surface, nullptr, crs, grid, {MapBand::sun, MapBand::shade, MapBand::elevation},
                           light);
  MapGround ground;
  const MapRows rows = sampler.rows(0, 1, ground);
  const auto column = [](double lon_deg) { return static_cast<std::size_t>((lon_deg - 7) / 0.1); };
  EXPECT_EQ(rows[0][column(9.35)], 0) << "in the shadow";
  EXPECT_GT(rows[0][column(8.35)], 0) << "beyond it";
  EXPECT_GT(rows[0][column(10.25)], rows[0][column(11.5)]) << "the slope towards the sun";
  EXPECT_EQ(rows[0][column(9.75)], 0) << "the slope away from it";
  // The light of shade comes from the north-west: the western slope is brighter than level ground, the eastern one darker.
  EXPECT_GT(rows[1][column(9.75)], rows[1][column(8.05)]);
  EXPECT_LT(rows[1][column(10.25)], rows[1][column(8.05)]);
  EXPECT_NEAR(rows[1][column(7.45)], std::sin(std::numbers::pi / 4), 0.02);
}

TEST_F(MapSamplerTest, HoursOfSunOnLevelGroundAreHalfTheSolAtTheEquator) {
  const test_support::TempDir dir;
  const auto planet =
      test_support::build_fake(dir / "s.vpe", FakeElevation([](const glm::dvec3&) { return 0.0; }), 60000);
  const paging::Surface surface(planet, 64 << 20);
  const mars::MapCrs crs("IAU_2015:49900", kMars_m);
  MapLight light;
  light.sol_s = 88775;
  constexpr double kSun_deg = 20;  // its latitude
  std::vector<glm::dvec3> sol;
  for (int i = 0; i <= 148; ++i) sol.push_back(mars::direction({180 - 360.0 * i / 148, kSun_deg}));
  light.sols = {sol};
  const MapGrid grid{0, 90, 10, 1, 18};
  const MapSampler sampler(surface, nullptr, crs, grid, {MapBand::sun_hours}, light);
  MapGround ground;
  const MapRows rows = sampler.rows(0, 18, ground);
  for (int row = 0; row < 18; ++row) {
    const double lat = (85 - 10.0 * row) * std::numbers::pi / 180;
    const double x = -std::tan(lat) * std::tan(kSun_deg * std::numbers::pi / 180);
    const double share = std::acos(std::clamp(x, -1.0, 1.0)) / std::numbers::pi;
    // Facets of 60 km are tilted by up to half a degree against the sphere.
    EXPECT_NEAR(rows[0][static_cast<std::size_t>(row)], share * 88775 / 3600, 0.25) << "row " << row;
  }
}

TEST_F(MapSamplerTest, ColoursAreThoseOfTheImagery) {
  const test_support::TempDir dir;
  paging::BuildOptions options;
  options.output = (dir / "c.vpe").string();
  options.base_spacing_m = 60000;
  options.tile_k = 5;
  options.resampling_posts = 1000;
  const test_support::FakeImage image;
  paging::build_planet(options, FakeElevation(test_support::bumpy_height), &image);
  const auto planet = paging::PlanetFile::open((dir / "c.vpe").string());
  const paging::Surface surface(planet, 32 << 20);
  const paging::TerrainShader shader(planet, 32 << 20);
  const mars::MapCrs crs("IAU_2015:49900", kMars_m);
  // Pixels as wide as the imagery's texels: wider ones are means. Texels are rounded down and interpolated.
  const MapGrid grid{-60, 30, 1, 36, 18};
  const MapSampler sampler(surface, &shader, crs, grid, {MapBand::elevation, MapBand::colour}, {});
  EXPECT_EQ(sampler.channels(), 4U);
  MapGround ground;
  const MapRows rows = sampler.rows(0, 18, ground);
  for (int row = 0; row < 18; ++row) {
    for (int column = 0; column < 36; ++column) {
      const glm::dvec2 p = grid.middle(column, row);
      const glm::dvec3 d = mars::direction({p.x, p.y});
      const auto i = static_cast<std::size_t>(row * 36 + column);
      for (int k = 0; k < 3; ++k) {
        const float value = rows[static_cast<std::size_t>(1 + k)][i];
        ASSERT_EQ(value, std::round(value));
        ASSERT_NEAR(value, std::max(1.0, 127 * (d[k] + 1)), 4) << row << ' ' << column;
      }
    }
  }
}

TEST_F(MapSamplerTest, BandsWithoutTheirLightAreRefused) {
  const mars::MapCrs crs("IAU_2015:49900", kMars_m);
  const MapGrid grid{0, 10, 1, 4, 4};
  for (const MapBand band : {MapBand::sun, MapBand::sun_hours, MapBand::colour})
    EXPECT_THROW(MapSampler(*surface_, nullptr, crs, grid, {band}, {}), std::invalid_argument);
}

class LongMapSampler : public MapSamplerTest {};

TEST_F(LongMapSampler, EqualsQueryAtAMillionPixels) {
  std::uint64_t seed = 7;
  for (const Case& c : kCases)
    EXPECT_EQ(count_differences(*surface_, c.crs, c.box, c.spacing_m, 100'000, ++seed), 0) << c.crs;
}

}  // namespace
