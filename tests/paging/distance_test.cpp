#include "paging/surface/distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/paging/planet_fixture.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::Random;
using test_support::TempDir;

// Returns the distance to the nearest of many points of all facets: an upper bound, and a lower one less `spacing_m`.
double sampled_distance_m(const paging::PlanetFile& planet, const glm::dvec3& place_m, double exaggeration,
                          int samples, double& spacing_m) {
  double nearest = 1e300;
  spacing_m = 0;
  for (const lod::TileInfo& info : planet.tree().tiles()) {
    if (info.has_children) continue;
    const paging::TileHeights heights = planet.heights(info.key, exaggeration);
    const lod::GridLines lines = lod::grid_lines(info.key, heights.posts.intervals);
    const auto post = [&](int i, int j) {
      return mars::chart_direction(info.key.face, lines.u[static_cast<std::size_t>(i)],
                                   lines.v[static_cast<std::size_t>(j)]) *
             (planet.radius_m() + exaggeration * heights.posts.at(i, j));
    };
    const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
      // Facets that are far away cannot hold the nearest point.
      const double size = std::max(glm::length(b - a), glm::length(c - a));
      if (glm::length(place_m - a) - 2 * size > nearest) return;
      spacing_m = std::max(spacing_m, size / samples);
      for (int u = 0; u <= samples; ++u)
        for (int v = 0; u + v <= samples; ++v)
          nearest = std::min(nearest, glm::length(place_m - (a + (b - a) * (double(u) / samples) +
                                                             (c - a) * (double(v) / samples))));
    };
    for (int j = 0; j < heights.posts.intervals; ++j) {
      for (int i = 0; i < heights.posts.intervals; ++i) {
        add(post(i, j), post(i + 1, j), post(i + 1, j + 1));
        add(post(i, j), post(i + 1, j + 1), post(i, j + 1));
      }
    }
  }
  return nearest;
}

TEST(DistanceToGround, AgreesWithSamplesOfAllFacets) {
  const TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 400'000);
  const paging::Surface surface(planet, std::size_t{32} << 20);
  Random random(20261125);
  for (int n = 0; n < 40; ++n) {
    const double exaggeration = n % 3 == 0 ? 5 : 1;
    const glm::dvec3 direction = random.direction();
    const double height_m = random.log_uniform(10, 3e6);
    const glm::dvec3 place_m = direction * (surface.at(direction, exaggeration).radius_m + height_m);
    const double is_m = paging::distance_to_ground_m(surface, place_m, exaggeration);
    double spacing_m = 0;
    const double sampled_m = sampled_distance_m(*planet, place_m, exaggeration, 12, spacing_m);
    EXPECT_LE(is_m, sampled_m + 1e-2) << n;
    EXPECT_LE(is_m, height_m * (1 + 1e-9) + 1e-2) << n;
    // The nearest sample is within half a spacing of the nearest point, along the facet.
    EXPECT_GE(std::hypot(is_m, spacing_m) + 1e-2, sampled_m) << n;
  }
}

TEST(DistanceToGround, IsNothingBelowTheGround) {
  const TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 400'000);
  const paging::Surface surface(planet, std::size_t{32} << 20);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1, 2, -0.5));
  EXPECT_EQ(paging::distance_to_ground_m(surface, direction * (surface.at(direction).radius_m - 100)), 0);
  EXPECT_EQ(paging::distance_to_ground_m(surface, glm::dvec3(0)), 0);
}

}  // namespace
