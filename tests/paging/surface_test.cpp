#include "paging/surface/surface.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <thread>

#include "tests/paging/planet_fixture.h"
#include "tests/support/worst.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;
using test_support::Random;
using test_support::TempDir;

const glm::dvec3 kCorner = glm::normalize(glm::dvec3(1, 1, 1));

struct Facet {
  glm::dvec3 a, b, c;
};

// Returns every facet of the reference surface, built in 3-D from the posts. Shares nothing with the caster
// but them.
std::vector<Facet> all_facets(const paging::PlanetFile& planet) {
  std::vector<Facet> out;
  for (const lod::TileInfo& info : planet.tree().tiles()) {
    if (info.has_children) continue;
    const paging::TileHeights heights = planet.heights(info.key);
    const lod::GridLines lines = lod::grid_lines(info.key, heights.posts.intervals);
    const auto post = [&](int i, int j) {
      return mars::chart_direction(info.key.face, lines.u[static_cast<std::size_t>(i)],
                                   lines.v[static_cast<std::size_t>(j)]) *
             (planet.radius_m() + heights.posts.at(i, j));
    };
    for (int j = 0; j < heights.posts.intervals; ++j) {
      for (int i = 0; i < heights.posts.intervals; ++i) {
        out.push_back({post(i, j), post(i + 1, j), post(i + 1, j + 1)});
        out.push_back({post(i, j), post(i + 1, j + 1), post(i, j + 1)});
      }
    }
  }
  return out;
}

double moller(const Facet& f, const glm::dvec3& camera, const glm::dvec3& d) {
  const glm::dvec3 e1 = f.b - f.a;
  const glm::dvec3 e2 = f.c - f.a;
  const glm::dvec3 p = glm::cross(d, e2);
  const double det = glm::dot(e1, p);
  if (det == 0) return std::numeric_limits<double>::infinity();
  const glm::dvec3 s = camera - f.a;
  const double u = glm::dot(s, p) / det;
  const glm::dvec3 q = glm::cross(s, e1);
  const double v = glm::dot(d, q) / det;
  const double t = glm::dot(e2, q) / det;
  const double slack = 1e-12;
  const bool inside = u >= -slack && v >= -slack && u + v <= 1 + slack && t > 0;
  return inside ? t : std::numeric_limits<double>::infinity();
}

TEST(Surface, CastAgreesWithEveryFacet) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.02, 60000));
  const auto planet = build_fake(dir / "p.vpe", source, 400000);
  const paging::Surface surface(planet, 1 << 26);
  const std::vector<Facet> facets = all_facets(*planet);
  Random random(41);
  int hits = 0;
  int misses = 0;
  for (int n = 0; n < 400; ++n) {
    // Cameras near a cube corner, near edges and anywhere; from 10 m above ground to ten radii.
    glm::dvec3 up = random.direction();
    if (n % 3 == 0) up = glm::normalize(kCorner + 0.02 * random.direction());
    const double height = random.log_uniform(10, 3.4e7);
    const glm::dvec3 camera = up * (surface.at(up).radius_m + height);
    // Between the nadir and a little above the horizon.
    const double dip = mars::horizon_dip_rad(height, planet->radius_m());
    const double pitch = random.uniform(-dip * 3 - 0.1, 0.02);
    const glm::dvec3 side = glm::normalize(glm::cross(up, random.direction()));
    const glm::dvec3 d = side * std::cos(pitch) + up * std::sin(pitch);
    double truth = std::numeric_limits<double>::infinity();
    for (const Facet& f : facets) truth = std::min(truth, moller(f, camera, d));
    const double cast = surface.cast(camera, d);
    ASSERT_EQ(std::isinf(cast), std::isinf(truth)) << n;
    if (std::isinf(truth)) {
      ++misses;
      continue;
    }
    ++hits;
    ASSERT_NEAR(cast, truth, 1e-9 * truth + 1e-6) << n;
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 50);
}

// A closed surface: no ray towards the planet's centre region gets through, from anywhere, also exactly along
// edges of the cube and of tiles.
TEST(Surface, NoRayGetsThrough) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 20000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface surface(planet, 1 << 26);
  Random random(42);
  for (int n = 0; n < 30000; ++n) {
    glm::dvec3 up = random.direction();
    glm::dvec3 target = random.direction();
    target *= random.uniform(0, 3.3e6);
    if (n % 4 == 0) {
      // In the plane of a cube edge or a tile border, where rays run along shared lines.
      up = glm::normalize(glm::dvec3{1, mars::face_line(random.integer(0, 8), 3), random.uniform(-1, 1)});
      target = glm::dvec3(0);
    }
    const glm::dvec3 camera = up * (planet->radius_m() + random.log_uniform(20000, 1e8));
    const double t = surface.cast(camera, glm::normalize(target - camera));
    ASSERT_TRUE(std::isfinite(t)) << n;
    const glm::dvec3 hit = camera + t * glm::normalize(target - camera);
    ASSERT_NEAR(glm::length(hit), surface.at(hit).radius_m, 1e-4) << n;
  }
}

// Where the depth of the tree changes, both sides give one surface at every exaggeration. Posts that were
// exaggerated one by one would not.
TEST(Surface, IsClosedAtEveryExaggeration) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 20000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface surface(planet, 1 << 26);
  const lod::TileTree& tree = planet->tree();
  Random random(45);
  for (const double x : {0.1, 1.0, 7.0, 100.0}) {
    double gap_m = 0;
    double each_by_itself_m = 0;
    int edges = 0;
    for (const lod::TileInfo& info : tree.tiles()) {
      if (info.has_children) continue;
      for (const lod::Edge edge : lod::kEdges) {
        const lod::TileInfo& beside = tree.deepest(lod::neighbour(info.key, edge).key);
        if (beside.key.level >= info.key.level) continue;
        ++edges;
        const auto own = surface.tile(info.key, x);
        const auto plain = surface.tile(info.key);
        const auto other = surface.tile(beside.key, x);
        for (int n = 0; n < 40; ++n) {
          const bool vertical = edge == lod::Edge::kWest || edge == lod::Edge::kEast;
          const bool far = edge == lod::Edge::kEast || edge == lod::Edge::kNorth;
          const auto ends = [&](const std::vector<double>& lines) {
            return far ? lines.back() : lines.front();
          };
          const auto along = [&](const std::vector<double>& lines) {
            return random.uniform(lines.front(), lines.back());
          };
          const double u = vertical ? ends(own->lines.u) : along(own->lines.u);
          const double v = vertical ? along(own->lines.v) : ends(own->lines.v);
          const mars::ChartPoint there = mars::chart_on(beside.key.face, mars::cube_point(info.key.face, u, v));
          const auto height = [&](const paging::SurfaceTile& tile, double cu, double cv) {
            return lod::surface_height(tile.data.posts, tile.lines, cu, cv, planet->radius_m(), nullptr, x);
          };
          const double outside = height(*other, there.u, there.v);
          gap_m = std::max(gap_m, std::abs(height(*own, u, v) - outside));
          each_by_itself_m = std::max(each_by_itself_m, std::abs(height(*plain, u, v) - outside));
        }
      }
    }
    EXPECT_GT(edges, 20);
    char claim[64];
    std::snprintf(claim, sizeof claim, "S is closed between levels, drawn %g times as high", x);
    test_support::record_worst(claim, gap_m, 1e-8 * std::max(1.0, x), "m");
    if (x > 1.0) {
      EXPECT_GT(each_by_itself_m, 10 * (x - 1)) << x;
    }
  }
}

TEST(Surface, NoRayGetsThroughExaggeratedGround) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 20000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface surface(planet, 1 << 26);
  Random random(46);
  for (const double x : {0.1, 7.0, 40.0}) {
    for (int n = 0; n < 8000; ++n) {
      const glm::dvec3 up = glm::normalize(kCorner + 0.2 * random.direction());
      const glm::dvec3 camera = up * (surface.at(up, x).radius_m + random.log_uniform(10, 1e7));
      const glm::dvec3 target = glm::normalize(kCorner + 0.2 * random.direction()) * 2.5e6;
      const glm::dvec3 direction = glm::normalize(target - camera);
      const double t = surface.cast(camera, direction, x);
      ASSERT_TRUE(std::isfinite(t)) << n << " times " << x;
      const glm::dvec3 hit = camera + t * direction;
      std::vector<double> radius_m(1);
      surface.radius(std::vector{hit}, radius_m, x);
      ASSERT_EQ(radius_m[0], surface.at(hit, x).radius_m);
      ASSERT_NEAR(glm::length(hit), radius_m[0], 1e-4) << n << " times " << x;
    }
  }
}

TEST(Surface, CameraBelowTheGroundHitsAtOnce) {
  TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 400000);
  const paging::Surface surface(planet, 1 << 26);
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 0.5, -0.8));
  EXPECT_EQ(surface.cast(up * (surface.at(up).radius_m - 100), up), 0.0);
}

TEST(Surface, NormalsPointUpTheFacet) {
  TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 200000);
  const paging::Surface surface(planet, 1 << 26);
  Random random(43);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 d = random.direction();
    const paging::SurfacePoint at = surface.at(d);
    const glm::dvec3 step = 1e-7 * random.direction();
    const glm::dvec3 p = d * at.radius_m;
    const glm::dvec3 q = glm::normalize(d + step) * surface.at(d + step).radius_m;
    ASSERT_LT(std::abs(glm::dot(at.normal, q - p)), 1e-6) << n;
    ASSERT_GT(glm::dot(at.normal, d), 0.3);
  }
}

// Eight threads with a cache that holds almost nothing get the results of one thread.
TEST(Surface, ThreadsAndEvictionDoNotChangeResults) {
  TempDir dir;
  const FakeElevation source(bumpy_height, fine_around(kCorner, 0.05, 40000));
  const auto planet = build_fake(dir / "p.vpe", source, 200000);
  const paging::Surface roomy(planet, 1 << 28);
  const paging::Surface tight(planet, 1 << 15);
  Random random(44);
  std::vector<glm::dvec3> directions(2000);
  for (auto& d : directions) d = random.direction();
  std::vector<double> expected(directions.size());
  roomy.radius(directions, expected);
  std::vector<std::vector<double>> found(8, std::vector<double>(directions.size()));
  {
    std::vector<std::jthread> threads;
    for (auto& out : found) threads.emplace_back([&] { tight.radius(directions, out); });
  }
  for (const auto& out : found) EXPECT_EQ(out, expected);
}

}  // namespace
