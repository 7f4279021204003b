#include "lod/mesh/block_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "lod/mesh/error_meter.h"
#include "tests/lod/mesh_terrain.h"
#include "tests/support/support.h"

namespace lod {

namespace {

using lod_test::kRadius;

constexpr int kIntervals = 64;

Posts rough_posts(const TileKey& key, std::uint64_t seed) {
  lod_test::Terrain terrain(seed, 0.01 * nominal_side_m(key.level, kRadius), nominal_side_m(key.level, kRadius),
                            0.8);
  return terrain.posts(key, kIntervals);
}

// Returns the radius of a mesh's flat triangle over a place of the chart, exaggerated, or 0 beside it.
double radius_on(const TileMesh& mesh, std::span<const double> height_m, const GridLines& lines, std::size_t t,
                 double x, const glm::dvec2& at) {
  glm::dvec2 place[3];
  double inverse[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = mesh.triangles[t + k];
    place[k] = {lines.u[mesh.vertices[n].i], lines.v[mesh.vertices[n].j]};
    inverse[k] = inverse_depth(place[k].x, place[k].y, x * height_m[n], kRadius);
  }
  const auto turn = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  const double whole = turn(place[1] - place[0], place[2] - place[0]);
  const double one = turn(at - place[0], place[2] - place[0]) / whole;
  const double two = turn(place[1] - place[0], at - place[0]) / whole;
  if (one < 0 || two < 0 || one + two > 1) return 0;
  const double w = inverse[0] + one * (inverse[1] - inverse[0]) + two * (inverse[2] - inverse[0]);
  return std::sqrt(at.x * at.x + at.y * at.y + 1) / w;
}

// Casts from random places of random triangles, and looks whether the blocks bound what is there, and closely.
TEST(BlockErrors, BoundTheMeshOverEachBlock) {
  test_support::Random random(31);
  double loosest = 0;
  for (int n = 0; n < 12; ++n) {
    const int level = n % 3 == 0 ? random.integer(0, 4) : random.integer(5, 12);
    const TileKey key{static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, (1 << level) - 1),
                      random.integer(0, (1 << level) - 1)};
    const Posts posts = rough_posts(key, static_cast<std::uint64_t>(n));
    const double tolerance_m = 0.002 * nominal_side_m(level, kRadius);
    const TileMesh mesh = mesh_greedy(posts, choose_borders(posts, tolerance_m, kRadius), tolerance_m, kRadius);
    const std::vector<double> heights = vertex_heights(mesh, posts);
    const GridLines lines = grid_lines(key, kIntervals);
    for (const double x : {1.0, 3.0}) {
      const int rows = n % 2 == 0 ? 16 : 4;
      const BlockErrors errors = block_errors(mesh, heights, posts, {kRadius, x, rows});
      ASSERT_EQ(errors.bound_m.size(), static_cast<std::size_t>(rows * rows));
      Posts exaggerated = posts;
      for (double& h : exaggerated.height_m) h *= x;
      std::vector<double> seen(errors.bound_m.size(), 0);
      for (int k = 0; k < 40000; ++k) {
        const auto t =
            3 * static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangle_count()) - 1));
        glm::dvec2 at(0);
        double share = 1;
        for (std::size_t c = 0; c < 3; ++c) {
          const double part = c == 2 ? share : share * random.uniform(0, 1);
          share -= part;
          const MeshVertex& v = mesh.vertices[mesh.triangles[t + c]];
          at += part * glm::dvec2(lines.u[v.i], lines.v[v.j]);
        }
        const double on_mesh_m = radius_on(mesh, heights, lines, t, x, at);
        if (on_mesh_m == 0) continue;
        const double off_m =
            std::abs(on_mesh_m - kRadius - surface_height(exaggerated, lines, at.x, at.y, kRadius));
        ASSERT_LE(off_m, errors.largest_m(at.x, at.y, 0) + 1e-6) << to_string(key) << " x " << x;
        const auto i = std::upper_bound(errors.u.begin() + 1, errors.u.end() - 1, at.x) - errors.u.begin() - 1;
        const auto j = std::upper_bound(errors.v.begin() + 1, errors.v.end() - 1, at.y) - errors.v.begin() - 1;
        double& most = seen[static_cast<std::size_t>(j * rows + i)];
        most = std::max(most, off_m);
      }
      double stated = 0;
      double found = 0;
      for (std::size_t b = 0; b < seen.size(); ++b) {
        stated += static_cast<double>(errors.bound_m[b]);
        found += seen[b];
      }
      loosest = std::max(loosest, stated / found);
      if (x != 1.0) continue;
      const ErrorTerms terms = measure_error(key, mesh, heights, posts, kRadius);
      const auto most = static_cast<double>(*std::max_element(errors.bound_m.begin(), errors.bound_m.end()));
      EXPECT_NEAR(most, terms.total_m, 0.05 * terms.total_m) << to_string(key);
    }
  }
  EXPECT_LE(loosest, 1.5);
  RecordProperty("loosest", std::to_string(loosest));
}

TEST(BlockErrors, AFullGridHasNone) {
  for (const int level : {0, 9}) {
    const Posts posts = rough_posts({mars::Face::kMinusY, level, 0, 0}, 3);
    const TileMesh mesh = mesh_full(kIntervals);
    for (const float bound_m : block_errors(mesh, vertex_heights(mesh, posts), posts, {kRadius}).bound_m)
      ASSERT_LE(bound_m, 1e-3F);
  }
}

// One post stands out of flat ground that the mesh leaves flat: the blocks around it have all of the error.
TEST(BlockErrors, ArePutWhereTheyAre) {
  const TileKey key{mars::Face::kPlusX, 9, 100, 300};
  const Posts flat = lod_test::make_posts(key, kIntervals, [](int, int) { return 0.0; });
  const Posts peak =
      lod_test::make_posts(key, kIntervals, [](int i, int j) { return i == 34 && j == 10 ? 70.0 : 0.0; });
  const double tolerance_m = 100;
  const TileMesh mesh = mesh_greedy(flat, choose_borders(flat, tolerance_m, kRadius), tolerance_m, kRadius);
  const BlockErrors errors = block_errors(mesh, vertex_heights(mesh, flat), peak, {kRadius, 1, 16});
  const GridLines lines = grid_lines(key, kIntervals);
  const double width = lines.u[1] - lines.u[0];
  const double elsewhere_m = errors.largest_m(lines.u[2], lines.v[40], 0);
  // The flat mesh is some metres below flat ground.
  EXPECT_NEAR(errors.largest_m(lines.u[34], lines.v[10], 0), 70, 7);
  EXPECT_LT(elsewhere_m, 10);
  EXPECT_LT(errors.largest_m(lines.u[42], lines.v[10], 0), 10);
  EXPECT_LT(errors.largest_m(lines.u[42], lines.v[10], 3 * width), 10);
  EXPECT_NEAR(errors.largest_m(lines.u[42], lines.v[10], 7 * width), 70, 7);
  // Beyond the tile its border counts.
  EXPECT_EQ(errors.largest_m(-9, lines.v[10], 0), errors.largest_m(lines.u[0], lines.v[10], 0));
  EXPECT_EQ(errors.largest_m(9, 9, 0), errors.largest_m(lines.u[kIntervals], lines.v[kIntervals], 0));
  EXPECT_GT(errors.bytes(), 16U * 16U * sizeof(float));
}

TEST(BlockErrors, RefuseWhatDoesNotFit) {
  const Posts posts = rough_posts({mars::Face::kPlusX, 3, 2, 2}, 1);
  const TileMesh mesh = mesh_full(kIntervals);
  const std::vector<double> heights = vertex_heights(mesh, posts);
  EXPECT_THROW(block_errors(mesh_full(32), heights, posts, {kRadius}), std::invalid_argument);
  EXPECT_THROW(block_errors(mesh, std::span(heights).first(7), posts, {kRadius}), std::invalid_argument);
  for (const int rows : {0, 3, 128})
    EXPECT_THROW(block_errors(mesh, heights, posts, {kRadius, 1, rows}), std::invalid_argument) << rows;
}

}  // namespace

}  // namespace lod
