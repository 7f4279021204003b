// Measured error against brute force and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "lod/mesh/error_meter.h"
#include "tests/lod/mesh_terrain.h"
#include "tests/support/support.h"

namespace lod {

namespace {

using lod_test::kRadius;
using lod_test::Terrain;

struct Case {
  TileKey key;
  Posts posts;  // the mesh's grid
  TileMesh mesh;
  Posts fine;
};

Posts ground(const TileKey& key, int intervals, std::uint64_t seed) {
  const double side = nominal_side_m(3, kRadius);
  Terrain terrain(seed, 0.01 * side, side, 0.8);
  terrain.add_craters(bounding_cap(key).centre, bounding_cap(key).radius_rad, 10, side / 30, side / 6);
  return terrain.posts(key, intervals);
}

Case make_case(test_support::Random& random, int depth) {
  Case c;
  const int level = random.integer(0, 9);
  c.key = {static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, (1 << level) - 1),
           random.integer(0, (1 << level) - 1)};
  const auto seed = static_cast<std::uint64_t>(random.integer(0, 1000));
  c.posts = ground(c.key, depth > 0 ? 64 : 32, seed);
  const double tolerance = nominal_side_m(level, kRadius) * random.log_uniform(3e-4, 3e-2);
  c.mesh = mesh_greedy(c.posts, choose_borders(c.posts, tolerance, kRadius), tolerance, kRadius);
  TileKey below = c.key;
  for (int d = 0; d < depth; ++d) below = child(below, random.integer(0, 3));
  c.fine = depth > 0 ? ground(below, 32, seed) : c.posts;
  return c;
}

Posts exaggerated(Posts posts, double x) {
  for (double& h : posts.height_m) h *= x;
  return posts;
}

// Returns the largest |mesh - S| over points of all mesh triangles on the fine tile: corners, edges and
// interiors.
double brute_m(const Case& c, double x, int steps) {
  const Posts mesh_posts = exaggerated(c.posts, x);
  const Posts fine = exaggerated(c.fine, x);
  const GridLines lines = grid_lines(c.key, c.mesh.intervals);
  const GridLines fine_lines = grid_lines(fine.key, fine.intervals);
  double worst = 0;
  for (std::size_t t = 0; t < c.mesh.triangles.size(); t += 3) {
    std::array<glm::dvec3, 3> corner;  // u, v, w
    for (std::size_t k = 0; k < 3; ++k) {
      const MeshVertex m = c.mesh.vertices[c.mesh.triangles[t + k]];
      const double u = lines.u[m.i];
      const double v = lines.v[m.j];
      corner[k] = {u, v, inverse_depth(u, v, mesh_posts.at(m.i, m.j), kRadius)};
    }
    for (int a = 0; a <= steps; ++a) {
      for (int b = 0; a + b <= steps; ++b) {
        const glm::dvec3 p = (corner[0] * static_cast<double>(a) + corner[1] * static_cast<double>(b) +
                              corner[2] * static_cast<double>(steps - a - b)) /
                             static_cast<double>(steps);
        if (p.x < fine_lines.u.front() || p.x > fine_lines.u.back() || p.y < fine_lines.v.front() ||
            p.y > fine_lines.v.back()) {
          continue;
        }
        const double radius = std::sqrt(p.x * p.x + p.y * p.y + 1.0) / p.z;
        worst =
            std::max(worst, std::abs(radius - kRadius - surface_height(fine, fine_lines, p.x, p.y, kRadius)));
      }
    }
  }
  return worst;
}

TEST(ErrorMeter, BoundsEveryDirectionAndIsNotLazy) {
  test_support::Random random(17);
  std::vector<double> ratios;
  for (int round = 0; round < 40; ++round) {
    const Case c = make_case(random, round % 4);
    const ErrorTerms terms = measure_error(c.key, c.mesh, vertex_heights(c.mesh, c.posts), c.fine, kRadius);
    const double truth = brute_m(c, 1.0, 40);
    ASSERT_LE(truth, terms.total_m + 2e-8) << to_string(c.key) << " round " << round;
    ASSERT_LE(terms.total_m, terms.height_error_m + terms.sagitta_m);
    if (truth > 1e-3) ratios.push_back(truth / terms.total_m);
  }
  ASSERT_GT(ratios.size(), 30U);
  std::sort(ratios.begin(), ratios.end());
  EXPECT_GE(ratios[ratios.size() / 2], 0.8);
  EXPECT_GE(ratios.front(), 0.3);
  RecordProperty("median_percent", static_cast<int>(100 * ratios[ratios.size() / 2]));
}

TEST(ErrorMeter, BoundHoldsAtEveryExaggeration) {
  test_support::Random random(23);
  std::vector<double> ratios;
  for (int round = 0; round < 24; ++round) {
    const Case c = make_case(random, round % 3);
    const ErrorTerms terms = measure_error(c.key, c.mesh, vertex_heights(c.mesh, c.posts), c.fine, kRadius);
    double low = c.posts.height_m[0];
    double high = low;
    for (const Posts* posts : {&c.posts, &c.fine}) {
      for (const double h : posts->height_m) {
        low = std::min(low, h);
        high = std::max(high, h);
      }
    }
    for (const double x : {-3.0, -1.0, 0.0, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 40.0}) {
      const double bound = error_bound(terms, x, low, high, kRadius);
      if (!std::isfinite(bound)) continue;
      const double truth = brute_m(c, x, 12);
      ASSERT_LE(truth, bound * (1 + 1e-12) + 1e-7) << to_string(c.key) << " exaggeration " << x;
      if (truth > 1e-3) ratios.push_back(truth / bound);
    }
  }
  ASSERT_GT(ratios.size(), 150U);
  std::sort(ratios.begin(), ratios.end());
  EXPECT_GE(ratios[ratios.size() / 2], 0.5);
}

TEST(ErrorMeter, ErrorBoundAtItsFixedPoints) {
  const ErrorTerms terms{10.0, 4.0, 12.0};
  EXPECT_EQ(error_bound(terms, 1.0, -5000, 5000, kRadius), 12.0);
  EXPECT_EQ(error_bound(terms, 0.0, -5000, 5000, kRadius), 4.0);
  EXPECT_EQ(error_bound(terms, 7.0, 300, 300, kRadius), 74.0);
  EXPECT_NEAR(error_bound(terms, 2.0, 0, 10000, kRadius), 24.0 + 2.0 * 1e8 / (4.0 * kRadius), 1e-9);
  EXPECT_TRUE(std::isinf(error_bound(terms, 1000.0, -8000, 0, kRadius)));
}

// One long hump that second order alone makes: height error at exaggeration 1 says little, the bound must hold.
TEST(ErrorMeter, SecondOrderIsNeeded) {
  const TileKey key{mars::Face::kPlusX, 5, 16, 16};
  Case c;
  c.key = key;
  c.mesh = mesh_greedy(lod_test::make_posts(key, 32, [](int, int) { return 0.0; }),
                       {std::vector{0, 32}, {0, 32}, {0, 32}, {0, 32}}, 1e9, kRadius);
  const GridLines lines = grid_lines(key, 32);
  // Heights on one plane in the chart at exaggeration 1, between 0 and 200 km: no error there but rounding.
  const auto corner = [&](int i, int j) {
    const double h = i == 0 ? 0.0 : 2e5;
    return inverse_depth(lines.u[static_cast<std::size_t>(i)], lines.v[static_cast<std::size_t>(j)], h,
                         kRadius);
  };
  c.posts = lod_test::make_posts(key, 32, [&](int i, int j) {
    const double fu = i / 32.0;
    const double fv = j / 32.0;
    const double w = fu > fv ? (1 - fu) * corner(0, 0) + (fu - fv) * corner(32, 0) + fv * corner(32, 32)
                             : (1 - fv) * corner(0, 0) + (fv - fu) * corner(0, 32) + fu * corner(32, 32);
    const double u = lines.u[static_cast<std::size_t>(i)];
    const double v = lines.v[static_cast<std::size_t>(j)];
    return std::sqrt(u * u + v * v + 1.0) / w - kRadius;
  });
  c.fine = c.posts;
  const ErrorTerms terms = measure_error(key, c.mesh, vertex_heights(c.mesh, c.posts), c.fine, kRadius);
  const auto [low, high] = std::minmax_element(c.posts.height_m.begin(), c.posts.height_m.end());
  const double truth = brute_m(c, 8.0, 64);
  EXPECT_GT(truth, 8.0 * terms.height_error_m + terms.sagitta_m);
  const double bound = error_bound(terms, 8.0, *low, *high, kRadius);
  EXPECT_LE(truth, bound);
  EXPECT_GT(truth, 0.2 * bound);
}

TEST(ErrorMeter, SmoothSphereHasTheClosedFormOfAChord) {
  for (const int level : {0, 1, 2, 4, 6, 8, 11}) {
    const TileKey key{mars::Face::kPlusY, level, (1 << level) / 3, (1 << level) / 2};
    const Posts fine = lod_test::make_posts(key, 64, [](int, int) { return 0.0; });
    const TileMesh mesh = mesh_greedy(fine, {std::vector{0, 64}, {0, 64}, {0, 64}, {0, 64}}, 1e9, kRadius);
    ASSERT_EQ(mesh.triangle_count(), 2U);
    const mars::ChartRect rect = chart_rect(key);
    const auto at = [&](double u, double v) { return mars::chart_direction(key.face, u, v); };
    const std::array<glm::dvec3, 4> p{at(rect.u0, rect.v0), at(rect.u1, rect.v0), at(rect.u1, rect.v1),
                                      at(rect.u0, rect.v1)};
    double want = 0;
    for (const auto& [a, b, c] : {std::array{p[0], p[1], p[2]}, std::array{p[0], p[2], p[3]}}) {
      const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
      const double depth = glm::dot(normal, a);
      const bool inside = glm::dot(glm::cross(a, b), normal) >= 0 && glm::dot(glm::cross(b, c), normal) >= 0 &&
                          glm::dot(glm::cross(c, a), normal) >= 0;
      const double chord = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
      want = std::max(want, 1.0 - (inside ? depth : std::sqrt(1.0 - 0.25 * chord * chord)));
    }
    // S is itself below the sphere by the chords of its cells.
    const double cell = std::numbers::pi / 2 / (64 << level) * 2.0;
    const double below = kRadius * (1.0 - std::cos(cell / 2)) + 1e-8;
    const ErrorTerms terms = measure_error(key, mesh, std::vector<double>(4, 0.0), fine, kRadius);
    EXPECT_GE(terms.sagitta_m, kRadius * want - below);
    EXPECT_LE(terms.sagitta_m, kRadius * want * (1.0 + 3.0 * cell) + 1e-8);
    EXPECT_LE(terms.height_error_m, terms.sagitta_m * 6.0 * cell + 1e-8);
  }
}

TEST(ErrorMeter, FullGridHasNoError) {
  for (const int level : {0, 4, 9}) {
    const TileKey key{mars::Face::kMinusZ, level, (1 << level) / 2, 0};
    const Posts posts = ground(key, 32, 2);
    const TileMesh mesh = mesh_full(32);
    const ErrorTerms terms = measure_error(key, mesh, vertex_heights(mesh, posts), posts, kRadius);
    EXPECT_LE(terms.total_m, 2e-8);
    EXPECT_LE(terms.sagitta_m, 2e-8);
    EXPECT_LE(terms.height_error_m, 4e-8);
  }
}

// One post is moved on the full grid: every tile that contains the post measures that displacement.
TEST(ErrorMeter, FindsAKnownError) {
  const TileKey key{mars::Face::kPlusX, 7, 40, 80};
  const Posts posts = ground(key, 64, 9);
  const TileMesh mesh = mesh_full(64);
  std::vector<double> heights = vertex_heights(mesh, posts);
  heights[32 * 65 + 32] += 123.0;
  const ErrorMeter meter(key, mesh, heights, kRadius);
  EXPECT_NEAR(meter.measure(posts).total_m, 123.0, 1.0);
  for (int c = 0; c < 4; ++c) {
    // The children's posts: S of the parent's grid, so that only the moved post differs.
    const TileKey below = child(key, c);
    const GridLines lines = grid_lines(below, 64);
    const GridLines own = grid_lines(key, 64);
    const Posts fine = lod_test::make_posts(below, 64, [&](int i, int j) {
      return surface_height(posts, own, lines.u[static_cast<std::size_t>(i)],
                            lines.v[static_cast<std::size_t>(j)], kRadius);
    });
    EXPECT_NEAR(meter.measure(fine).total_m, 123.0, 1.0);
  }
}

// A parent's terms are those over all tiles below it, and S over a tile is the same from any of them.
TEST(ErrorMeter, TermsOverATileIncludeThoseOverItsParts) {
  const TileKey key{mars::Face::kPlusZ, 5, 13, 20};
  const Posts coarse = ground(key, 64, 12);
  const TileMesh mesh = mesh_greedy(coarse, choose_borders(coarse, 200.0, kRadius), 200.0, kRadius);
  const ErrorMeter meter(key, mesh, vertex_heights(mesh, coarse), kRadius);
  // S over the tile is its 64 grid; its children's 32 grids show the same facets.
  ErrorTerms parts;
  for (int c = 0; c < 4; ++c) {
    const int i0 = 32 * (c % 2);
    const int j0 = 32 * (c / 2);
    parts.include(meter.measure(
        lod_test::make_posts(child(key, c), 32, [&](int i, int j) { return coarse.at(i0 + i, j0 + j); })));
  }
  const ErrorTerms whole = meter.measure(coarse);
  EXPECT_NEAR(parts.total_m, whole.total_m, 1e-3 * whole.total_m);
  EXPECT_NEAR(parts.height_error_m, whole.height_error_m, 1e-3 * whole.height_error_m);
  EXPECT_NEAR(parts.sagitta_m, whole.sagitta_m, 1e-3 * whole.sagitta_m);
}

TEST(ErrorMeter, RefusesWhatDoesNotFit) {
  const TileKey key{mars::Face::kPlusX, 3, 2, 2};
  const TileMesh mesh = mesh_full(16);
  const std::vector<double> heights(mesh.vertices.size(), 0.0);
  const auto flat = [](const TileKey& k, int n) {
    return lod_test::make_posts(k, n, [](int, int) { return 0.0; });
  };
  EXPECT_THROW(ErrorMeter(key, mesh, std::vector<double>(3, 0.0), kRadius), std::invalid_argument);
  const ErrorMeter meter(key, mesh, heights, kRadius);
  EXPECT_THROW(meter.measure(flat({mars::Face::kPlusX, 3, 3, 2}, 16)), std::invalid_argument);
  EXPECT_THROW(meter.measure(flat(parent(key), 16)), std::invalid_argument);
  EXPECT_THROW(meter.measure(flat(key, 8)), std::invalid_argument);
  EXPECT_THROW(meter.measure(FinePosts(flat(key, 16), 2 * kRadius)), std::invalid_argument);
}

}  // namespace

}  // namespace lod
