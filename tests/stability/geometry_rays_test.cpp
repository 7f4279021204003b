// Rays against terrain that strains arithmetic: hits lie on the reference surface, and no ray passes through
// it.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

#include "tests/stability/terrains.h"
#include "tests/support/worst.h"

namespace {

using test_support::build_ground;
using test_support::kFacePosts;
using test_support::Random;
using test_support::record_worst;
using test_support::StrangeGround;

constexpr std::size_t kBudget = std::size_t{1} << 26;

struct Ray {
  glm::dvec3 camera_m;
  glm::dvec3 direction;
};

glm::dvec3 random_post(Random& random) {
  const auto face = static_cast<mars::Face>(random.integer(0, 5));
  const int i = random.integer(0, kFacePosts);
  const int j = random.integer(0, kFacePosts);
  return mars::chart_direction(face, mars::face_line(i, 6), mars::face_line(j, 6));
}

// Returns a camera over any place, often a pole, edge or post, from 1e-7 to ten radii above the reference
// surface.
glm::dvec3 random_camera(Random& random, const paging::Surface& surface, double exaggeration) {
  static const std::vector<mars::LonLat> places = test_support::hostile_places();
  glm::dvec3 up = random.direction();
  const int kind = random.integer(0, 2);
  if (kind == 0)
    up = mars::direction(
        places[static_cast<std::size_t>(random.integer(0, static_cast<int>(places.size()) - 1))]);
  if (kind == 1) up = random_post(random);
  const double above = random.log_uniform(1e-7, 10) * surface.planet_radius_m();
  return up * (surface.at(up, exaggeration).radius_m + above);
}

Ray random_ray(Random& random, const paging::Surface& surface, double exaggeration) {
  const glm::dvec3 camera = random_camera(random, surface, exaggeration);
  const glm::dvec3 up = glm::normalize(camera);
  const double radius_m = surface.planet_radius_m();
  const glm::dvec3 post = random_post(random);
  switch (random.integer(0, 5)) {
    case 0: return {camera, -up};
    case 1: return {camera, up};
    case 2:
      return {camera,
              glm::normalize(post * surface.at(post, exaggeration).radius_m - camera)};  // through a post
    case 3: {  // in the plane of a grid line, where two neighbours are tested against the same lines
      const mars::Face face = mars::chart_point(up).face;
      const double u = mars::face_line(random.integer(0, kFacePosts), 6);
      const glm::dvec3 on = mars::chart_direction(face, u, random.uniform(-1, 1));
      const glm::dvec3 to = mars::chart_direction(face, u, random.uniform(-1, 1)) * (0.9 * radius_m);
      const glm::dvec3 from =
          on * std::max(glm::length(camera), 1.0001 * surface.at(on, exaggeration).radius_m);
      return {from, glm::normalize(to - from)};
    }
    case 4: {  // touching the sphere, or about to
      const glm::dvec3 side = glm::normalize(glm::cross(up, random.direction()));
      const double dip =
          mars::horizon_dip_rad(glm::length(camera) - radius_m, radius_m) + random.uniform(-1e-3, 1e-3);
      return {camera, side * std::cos(dip) - up * std::sin(dip)};
    }
    default: return {camera, random.direction()};
  }
}

struct Worst {
  double off = 0;      // distance of a hit from its facet, over the distances to centre and camera
  double through = 0;  // depth of a ray below the reference surface before its hit, likewise
  int hits = 0;
  int misses = 0;
};

void check(Random& random, const paging::Surface& surface, double exaggeration, int rays, Worst& worst) {
  for (int n = 0; n < rays; ++n) {
    const Ray ray = random_ray(random, surface, exaggeration);
    const double hit_m = surface.cast(ray.camera_m, ray.direction, exaggeration);
    ASSERT_FALSE(std::isnan(hit_m) || hit_m < 0);
    const double away_m = glm::length(ray.camera_m);
    // Past the far side of everything when nothing is hit.
    const double length_m = std::isfinite(hit_m) ? hit_m : 2.2 * away_m;
    const double scale_m = away_m + length_m;
    (std::isfinite(hit_m) ? worst.hits : worst.misses) += 1;
    const auto below_m = [&](double t) {
      const glm::dvec3 p = ray.camera_m + t * ray.direction;
      const paging::SurfacePoint s = surface.at(p, exaggeration);
      // Across the facet, because the radius is ambiguous on a wall.
      return (s.radius_m - glm::length(p)) * glm::dot(s.normal, glm::normalize(p));
    };
    if (std::isfinite(hit_m)) worst.off = std::max(worst.off, std::abs(below_m(hit_m)) / scale_m);
    for (int k = 0; k < 24; ++k) {
      const double t = length_m * random.uniform(0, 1);
      worst.through = std::max(worst.through, below_m(t) / scale_m);
    }
  }
}

TEST(GeometryRays, HitWhatIsThereAndNothingElse) {
  test_support::TempDir dir;
  Random random(311);
  Worst worst;
  int n = 0;
  for (const double radius_m : {1.0, mars::kMarsRadius_m, 1e8}) {
    for (const StrangeGround& ground : test_support::strange_grounds(0.008)) {
      const auto planet = build_ground(dir / std::to_string(n++), radius_m, ground);
      ASSERT_EQ(planet->meta().finest_level, 1);
      const paging::Surface surface(planet, kBudget);
      for (const double exaggeration : {0.1, 1.0, 100.0}) {
        SCOPED_TRACE(std::string(ground.name) + " on a radius of " + std::to_string(radius_m) + " m times " +
                     std::to_string(exaggeration));
        check(random, surface, exaggeration, 300, worst);
      }
    }
  }
  EXPECT_GT(worst.hits, 10000);
  EXPECT_GT(worst.misses, 5000);
  record_worst("casts: hits lie on S", worst.off, 1e-13, "of the distances to centre and camera");
  record_worst("casts: nothing is passed through", worst.through, 1e-13,
               "of the distances to centre and camera");
}

// Heights from near the planet's centre to the largest that can be stored.
TEST(GeometryRays, RampFromTheCentreToTheLargestHeightThatCanBeStored) {
  test_support::TempDir dir;
  constexpr double kRadius_m = 1e6;
  paging::BuildOptions options;
  options.output = (dir / "ramp.vpe").string();
  options.radius_m = kRadius_m;
  options.tile_k = 5;
  options.base_spacing_m = 1.01 * lod::post_spacing_m(1, 32, kRadius_m);
  options.quantum_m = 1;
  const test_support::FakeElevation source(
      [](const glm::dvec3& d) { return -999000 + (2147483647.0 + 999000) * (0.5 + 0.5 * d.z); });
  paging::build_planet(options, source, nullptr);
  const auto planet = paging::PlanetFile::open(options.output);
  const paging::Surface surface(planet, kBudget);
  EXPECT_NEAR(surface.at({0, 0, 1}).height_m, 2147483647.0, 0.5);
  EXPECT_NEAR(surface.at({0, 0, -1}).height_m, -999000.0, 0.5);
  Random random(312);
  Worst worst;
  check(random, surface, 1.0, 2000, worst);
  record_worst("casts: a ramp over 2000 radii", std::max(worst.off, worst.through), 1e-12,
               "of the distances to centre and camera");
}

// At every special place, the range downwards is the height above the reference surface, and upwards is the
// sky.
TEST(GeometryRays, StraightDownIsTheHeightAndStraightUpTheSky) {
  test_support::TempDir dir;
  double off = 0;
  int n = 0;
  for (const double radius_m : {1.0, 1e8}) {
    for (const StrangeGround& ground : test_support::strange_grounds(0.008)) {
      const auto planet = build_ground(dir / std::to_string(n++), radius_m, ground);
      const paging::Surface surface(planet, kBudget);
      for (const mars::LonLat& place : test_support::hostile_places()) {
        const glm::dvec3 up = mars::direction(place);
        for (const double height : {1e-7, 1e-3, 1.0, 10.0}) {
          const double ground_m = surface.at(up).radius_m;
          const glm::dvec3 camera = up * (ground_m + height * radius_m);
          const double down_m = surface.cast(camera, -glm::normalize(camera));
          off = std::max(off, std::abs(down_m - (glm::length(camera) - ground_m)) / glm::length(camera));
          ASSERT_EQ(surface.cast(camera, glm::normalize(camera)), std::numeric_limits<double>::infinity())
              << ground.name << " " << place.lon_deg << " " << place.lat_deg;
        }
      }
    }
  }
  // Between two posts of a wall the foot of the ray moves by its own rounding, 1.2e-16, times the slope.
  record_worst("casts: straight down", off, 1e-13, "of the distance from the centre");
}

// Nodata ground is drawn and reported.
TEST(GeometryRays, NodataGroundIsDrawnAndReported) {
  test_support::TempDir dir;
  const auto planet =
      build_ground(dir / "none", 1e6, {"no data", [](const glm::dvec3&) { return std::nan(""); }});
  const paging::Surface surface(planet, kBudget);
  Random random(313);
  for (int n = 0; n < 200; ++n) {
    const paging::SurfacePoint at = surface.at(random.direction());
    ASSERT_TRUE(at.nodata);
    ASSERT_NEAR(at.height_m, planet->meta().fill_m, 1e6 / 1000);
  }
}

// A finite height that cannot be stored is refused with a message; it never becomes another height.
TEST(GeometryRays, HeightsThatCannotBeStoredAreRefused) {
  test_support::TempDir dir;
  for (const double wild_m : {3.0e38, -3.4028226550889045e38, 1e25, 1e13, -1e13}) {
    const glm::dvec3 post =
        mars::chart_direction(mars::Face::kPlusX, mars::face_line(40, 6), mars::face_line(24, 6));
    const StrangeGround ground{
        "wild", [&](const glm::dvec3& d) { return glm::length(d - post) < 1e-9 ? wild_m / 1e6 : 0; }};
    try {
      build_ground(dir / "wild.vpe", 1e6, ground);
      FAIL() << wild_m << " was accepted";
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("height"), std::string::npos) << e.what();
    }
    EXPECT_FALSE(std::filesystem::exists(dir / "wild.vpe"));
  }
}

TEST(GeometryRays, RadiiOutOfRangeAreRefusedBeforeAnythingIsBuilt) {
  test_support::TempDir dir;
  const StrangeGround flat{"flat", [](const glm::dvec3&) { return 0.0; }};
  for (const double radius_m : {0.999, 0.0, -1.0, 1e12, std::nan("")}) {
    try {
      build_ground(dir / "p.vpe", radius_m, flat);
      FAIL() << radius_m << " was accepted";
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("radius"), std::string::npos) << e.what();
    }
    EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
  }
}

}  // namespace
