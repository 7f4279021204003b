// The skyline over ground with a known horizon, and over the reference surface.
#include "panorama/horizon/skyline.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/paging/planet_fixture.h"

namespace {

using panorama::Direction;
using panorama::GroundPoint;
using panorama::Viewpoint;
using test_support::Random;
using vpe::base::ThreadPool;

constexpr double kR = mars::kMarsRadius_m;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where a ray meets a sphere, in extended precision: near the horizon the root is a small difference.
panorama::GroundRange sphere_range(const Viewpoint& camera, double radius_m) {
  return [=](const glm::dvec3& ray) {
    const auto dot = [](const glm::dvec3& a, const glm::dvec3& b) {
      return static_cast<long double>(a.x) * b.x + static_cast<long double>(a.y) * b.y +
             static_cast<long double>(a.z) * b.z;
    };
    const long double length2 = dot(ray, ray);
    const long double along = -dot(camera.position_m, ray) / length2;
    const long double miss2 = dot(camera.position_m, camera.position_m) - along * along * length2;
    const long double half2 = static_cast<long double>(radius_m) * radius_m - miss2;
    if (along < 0 || half2 < 0) return kInfinity;
    return static_cast<double>(along - std::sqrt(half2 / length2));
  };
}

// Ground up to an elevation that is a function of azimuth, 1 km away.
panorama::GroundRange wall_range(const Viewpoint& camera, const std::function<double(double)>& top_deg) {
  return [=](const glm::dvec3& ray) {
    const double east = glm::dot(ray, camera.frame.east);
    const double north = glm::dot(ray, camera.frame.north);
    const double azimuth = std::atan2(east, north) / mars::kRadiansPerDegree;
    const double elevation =
        std::atan2(glm::dot(ray, camera.frame.up), std::hypot(east, north)) / mars::kRadiansPerDegree;
    return elevation <= top_deg(azimuth) ? 1000.0 : kInfinity;
  };
}

TEST(Skyline, OfTheSphereFromTenCentimetresToOrbitAlsoAtPoles) {
  Random random(1);
  double worst_deg = 0;
  double worst_share = 0;
  for (int n = 0; n < 2000; ++n) {
    mars::LonLat place{random.uniform(-180, 180), random.uniform(-90, 90)};
    if (n % 4 == 0) place.lat_deg = n % 8 == 0 ? 90 : -90;
    const double alt = random.log_uniform(0.1, 1e9);
    const Viewpoint camera = panorama::viewpoint_at(place, alt, kR);
    const double azimuth = random.uniform(0, 360);
    const GroundPoint p = panorama::skyline_at(camera, azimuth, sphere_range(camera, kR));
    const double dip = mars::horizon_dip_rad(alt, kR) / mars::kRadiansPerDegree;
    worst_deg = std::max(worst_deg, std::abs(p.direction.elevation_deg + dip));
    const double distance = mars::horizon_distance_m(alt, kR);
    worst_share = std::max(worst_share, std::abs(p.range_m - distance) / distance);
    EXPECT_NEAR(p.elevation_m, 0, 1e-4 + 1e-12 * alt);
    // A dip away along the great circle.
    EXPECT_NEAR(mars::distance_rad(place, p.place) / mars::kRadiansPerDegree, dip, 1e-3 * dip + 1e-9);
    if (std::abs(place.lat_deg) < 89.9) {
      const double bearing = mars::initial_bearing_deg(place, p.place);
      EXPECT_NEAR(std::remainder(bearing - azimuth, 360), 0, 1e-5) << alt;
    }
  }
  RecordProperty("elevation_deg", std::to_string(worst_deg));
  EXPECT_LT(worst_deg, 2 * panorama::kSkyline_deg);  // 1e-5 is asked for
  EXPECT_LT(worst_share, 1e-3);
}

TEST(Skyline, WrongBracketsCostOnlyTime) {
  Random random(2);
  const Viewpoint camera = panorama::viewpoint_at({30, 40}, 2, kR);
  for (int n = 0; n < 300; ++n) {
    const double top = n % 5 == 0 ? random.uniform(-89.999, 89.999) : random.uniform(-20, 20);
    const auto range = wall_range(camera, [&](double) { return top; });
    double low = random.uniform(-95, 95);
    double high = low + random.uniform(-5, 100);
    if (n % 3 == 0) low = high = top + random.uniform(-0.2, 0.2);
    const GroundPoint p = panorama::skyline_at(camera, 77, range, {low, high});
    EXPECT_NEAR(p.direction.elevation_deg, top, 2 * panorama::kSkyline_deg) << low << " " << high;
    EXPECT_LE(p.direction.elevation_deg, top + 1e-12);
    EXPECT_EQ(p.range_m, 1000);
  }
}

TEST(Skyline, DeepPitsAndNoGround) {
  const Viewpoint camera = panorama::viewpoint_at({0, 0}, -3000, kR);
  const auto pit = [](double azimuth) { return 80 + 9.9 * std::cos(azimuth * mars::kRadiansPerDegree); };
  ThreadPool pool(2);
  const std::vector<double> azimuths{0, 90, 180, 270, 359.9};
  const auto points = panorama::skyline(camera, azimuths, wall_range(camera, pit), pool);
  for (std::size_t n = 0; n < azimuths.size(); ++n)
    EXPECT_NEAR(points[n].direction.elevation_deg, pit(azimuths[n]), 1e-6);
  EXPECT_THROW(panorama::skyline_at(camera, 0, [](const glm::dvec3&) { return kInfinity; }),
               std::invalid_argument);
}

// The brackets of an image hold the skyline where it is even, so that nothing is cast in vain.
TEST(Skyline, BracketsOfAnImage) {
  const Viewpoint camera = panorama::viewpoint_at({10, 20}, 100, kR);
  const auto top = [](double azimuth) { return 5 * std::sin(2 * azimuth * mars::kRadiansPerDegree); };
  const auto range = wall_range(camera, top);
  panorama::PanoramaMap map = panorama::equirectangular_map(720, 360, 720, 123.0, 180);
  std::vector<float> ranges;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 720; ++x)
      ranges.push_back(static_cast<float>(range(ray_of(camera, map.to_direction(x + 0.5, y + 0.5)))));
  }
  std::vector<double> azimuths;
  for (int n = 0; n < 360; ++n) azimuths.push_back(n + 0.3);
  const auto brackets = panorama::first_brackets({map, ranges}, azimuths);
  for (std::size_t n = 0; n < azimuths.size(); ++n) {
    EXPECT_LT(brackets[n].low_deg, top(azimuths[n])) << azimuths[n];
    EXPECT_GT(brackets[n].high_deg, top(azimuths[n])) << azimuths[n];
    EXPECT_LT(brackets[n].high_deg - brackets[n].low_deg, 2.0);
  }
}

// A gap low in the image through which ground far away is seen, below nearer ground.
TEST(Skyline, TheFarthestGroundIsFoundBelowTheSkylineToo) {
  const Viewpoint camera = panorama::viewpoint_at({10, 20}, 100, kR);
  const auto flat = wall_range(camera, [](double) { return 3.0; });
  const panorama::GroundRange range = [&](const glm::dvec3& ray) {
    const Direction gap{200.1, -1.0};
    const double off = std::acos(std::min(1.0, glm::dot(ray, ray_of(camera, gap)))) / mars::kRadiansPerDegree;
    return off < 0.4 ? 5000.0 + 100 * off : flat(ray);
  };
  panorama::PanoramaMap map = panorama::equirectangular_map(720, 360, 720, 0, 180);
  std::vector<float> ranges;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 720; ++x)
      ranges.push_back(static_cast<float>(range(ray_of(camera, map.to_direction(x + 0.5, y + 0.5)))));
  }
  ThreadPool pool(2);
  const GroundPoint p = panorama::farthest_ground(camera, {map, ranges}, {}, range, pool);
  float farthest = 0;
  for (const float r : ranges) farthest = std::isinf(r) ? farthest : std::max(farthest, r);
  EXPECT_GT(farthest, 5000);
  EXPECT_NEAR(p.range_m, static_cast<double>(farthest), 1e-3);
  EXPECT_NEAR(p.direction.azimuth_deg, 200.1, 0.4);
  EXPECT_NEAR(p.direction.elevation_deg, -1, 0.4);
  // One of the skyline is taken where that is farther, and then searched about for better.
  const panorama::GroundRange notch = [&](const glm::dvec3& ray) {
    const double azimuth = std::atan2(glm::dot(ray, camera.frame.east), glm::dot(ray, camera.frame.north));
    const bool inside = std::abs(azimuth / mars::kRadiansPerDegree - 60.0) < 0.1;
    return std::isfinite(flat(ray)) ? (inside ? 9000.0 : 1000.0) : kInfinity;
  };
  const std::vector<float> same(ranges.size(), 1000.0F);
  const std::vector<GroundPoint> skyline{panorama::skyline_at(camera, 60.05, notch)};
  EXPECT_EQ(panorama::farthest_ground(camera, {map, same}, skyline, notch, pool).range_m, 9000);
}

class SkylineOfTheSurface : public testing::Test {
 protected:
  test_support::TempDir dir_;
};

// Heights are all 0, but the surface is flat between posts: 100 m apart, so the sagitta is below 1 mm (2e-7
// degrees from 261 km) and an edge is never farther from the horizon than 0.1 %.
TEST_F(SkylineOfTheSurface, OfAPlanetWithoutRelief) {
  const mars::LonLat place{12, 34};
  constexpr double kAlt = 10000;
  const double dip = mars::horizon_dip_rad(kAlt, kR);
  const mars::LonLat horizon = mars::destination(place, 70, dip);
  const auto planet = test_support::build_fake(
      dir_ / "p.vpe",
      test_support::FakeElevation([](const glm::dvec3&) { return 0.0; },
                                  test_support::fine_around(mars::direction(horizon), 5000 / kR, 100)),
      400000);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const Viewpoint camera = panorama::viewpoint_at(place, kAlt, kR);
  ThreadPool pool(2);
  std::vector<double> azimuths;
  for (int n = -10; n <= 10; ++n) azimuths.push_back(70 + 0.05 * n);
  const auto points = panorama::skyline(
      camera, azimuths, [&](const glm::dvec3& ray) { return surface.cast(camera.position_m, ray); }, pool);
  const double distance = mars::horizon_distance_m(kAlt, kR);
  for (const GroundPoint& p : points) {
    EXPECT_NEAR(p.direction.elevation_deg, -dip / mars::kRadiansPerDegree, 1e-6);
    EXPECT_NEAR(p.range_m, distance, 1e-3 * distance);
    EXPECT_NEAR(p.elevation_m, surface.at(mars::direction(p.place)).height_m, 1e-3);
  }
}

// No ray a little above the skyline meets the reference surface, for any relief.
TEST_F(SkylineOfTheSurface, IsTheHighestGround) {
  const auto planet =
      test_support::build_fake(dir_ / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 60000);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  Random random(3);
  for (int n = 0; n < 60; ++n) {
    const mars::LonLat place{random.uniform(-180, 180), n % 6 == 0 ? 90.0 : random.uniform(-90, 90)};
    const double alt = surface.at(mars::direction(place)).height_m + random.log_uniform(0.5, 1e7);
    const Viewpoint camera = panorama::viewpoint_at(place, alt, kR);
    const panorama::GroundRange range = [&](const glm::dvec3& ray) {
      return surface.cast(camera.position_m, ray);
    };
    const double azimuth = random.uniform(0, 360);
    const GroundPoint p = panorama::skyline_at(camera, azimuth, range);
    EXPECT_NEAR(surface.at(mars::direction(p.place)).height_m, p.elevation_m, 1e-2 + 1e-8 * p.range_m);
    double nearer = p.range_m;
    for (const double above : {1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0}) {
      EXPECT_TRUE(std::isinf(range(ray_of(camera, {azimuth, p.direction.elevation_deg + above}))));
      const double below = p.direction.elevation_deg - above;
      if (below <= -90) continue;
      const double met = range(ray_of(camera, {azimuth, below}));
      EXPECT_LE(met, nearer * (1 + 1e-9));
      nearer = met;
    }
  }
}

}  // namespace
