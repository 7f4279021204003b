// What meters leave out never has the largest distance: terms with and without it have equal bits.
#include "lod/mesh/overlay_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lod/mesh/error_meter.h"
#include "lod/mesh/grid_meter.h"
#include "tests/lod/mesh_terrain.h"
#include "tests/support/support.h"

namespace lod {

namespace {

using lod_test::kRadius;

TileKey random_key(test_support::Random& random, int level) {
  return {static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, (1 << level) - 1),
          random.integer(0, (1 << level) - 1)};
}

// Ground with craters, and cliffs of a cell, so that differences between posts are small and large.
Posts ground(const TileKey& key, int intervals, std::uint64_t seed, double cliff_m) {
  const double side = nominal_side_m(3, kRadius);
  lod_test::Terrain terrain(seed, 0.01 * side, side, 0.8);
  terrain.add_craters(bounding_cap(key).centre, bounding_cap(key).radius_rad, 10, side / 30, side / 6);
  Posts posts = terrain.posts(key, intervals);
  test_support::Random random(seed);
  for (double& h : posts.height_m)
    if (random.integer(0, 99) == 0) h += cliff_m;
  return posts;
}

void expect_same(const ErrorTerms& some, const ErrorTerms& all, const TileKey& key) {
  EXPECT_EQ(some.total_m, all.total_m) << to_string(key);
  EXPECT_EQ(some.sagitta_m, all.sagitta_m) << to_string(key);
  EXPECT_EQ(some.height_error_m, all.height_error_m) << to_string(key);
}

TEST(OverlayCut, MeshesKeepTheBitsOfTheirErrors) {
  test_support::Random random(20261128);
  for (int round = 0; round < 120; ++round) {
    const TileKey key = random_key(random, random.integer(0, 14));
    const bool is_inner = round % 3 == 2;
    const double cliff_m = round % 2 == 0 ? 0.0 : random.log_uniform(1, 5000);
    const auto seed = static_cast<std::uint64_t>(random.integer(0, 1000));
    const Posts posts = ground(key, is_inner ? 64 : 32, seed, cliff_m);
    const Posts fine = is_inner ? ground(child(key, random.integer(0, 3)), 32, seed, cliff_m) : posts;
    const double tolerance_m = nominal_side_m(key.level, kRadius) * random.log_uniform(3e-5, 3e-2);
    const TileMesh mesh = mesh_greedy(posts, choose_borders(posts, tolerance_m, kRadius), tolerance_m, kRadius);
    const ErrorMeter meter(key, mesh, vertex_heights(mesh, posts), kRadius);
    const FinePosts prepared(fine, kRadius);
    expect_same(meter.measure(prepared), meter.measure_all(prepared), fine.key);
  }
}

TEST(OverlayCut, GridsKeepTheBitsOfTheirErrors) {
  test_support::Random random(20261129);
  for (int round = 0; round < 120; ++round) {
    const TileKey key = random_key(random, random.integer(0, 12));
    TileKey below = key;
    for (int d = random.integer(0, 7); d > 0; --d) below = child(below, random.integer(0, 3));
    const double cliff_m = round % 2 == 0 ? 0.0 : random.log_uniform(1, 5000);
    const auto seed = static_cast<std::uint64_t>(random.integer(0, 1000));
    const GridMeter meter(ground(key, 32, seed, cliff_m), kRadius);
    Posts fine = ground(below, 32, seed, cliff_m);
    if (round % 5 == 0)
      for (double& h : fine.height_m) h -= 9000;  // below the sphere everywhere
    const FinePosts prepared(fine, kRadius);
    expect_same(meter.measure(prepared), meter.measure_all(prepared), below);
  }
}

// Most pieces of a mesh of usual size are left out once large distances are known, and none before.
TEST(OverlayCut, LeavesOutMostPieces) {
  const TileKey key{mars::Face::kPlusX, 5, 11, 20};
  const Posts posts = ground(key, 64, 7, 0.0);
  const double tolerance_m = nominal_side_m(key.level, kRadius) * 1e-4;
  const TileMesh mesh = mesh_greedy(posts, choose_borders(posts, tolerance_m, kRadius), tolerance_m, kRadius);
  const CoarseMesh coarse(key, mesh, vertex_heights(mesh, posts), kRadius);
  const FineGrid fine(posts, kRadius);
  const OverlayCut cut(coarse, fine, 0, 0);
  const ErrorTerms terms = measure_error(key, mesh, vertex_heights(mesh, posts), posts, kRadius);
  const LargestDistances most{terms.total_m, terms.sagitta_m, terms.height_error_m};
  const LargestDistances beyond{2 * terms.total_m, 2 * terms.sagitta_m, 3 * terms.total_m};
  std::size_t triangles = 0;
  for (std::size_t k = 0; k < coarse.triangles.size(); ++k) {
    EXPECT_FALSE(cut.leaves_out(coarse.triangles[k], coarse.triangle_boxes[k], LargestDistances{}));
    EXPECT_TRUE(cut.leaves_out(coarse.triangles[k], coarse.triangle_boxes[k], beyond));
    triangles += cut.leaves_out(coarse.triangles[k], coarse.triangle_boxes[k], most) ? 1 : 0;
  }
  EXPECT_GE(triangles, coarse.triangles.size() * 9 / 10);
  std::size_t slanting = 0;
  std::size_t segments = 0;
  for (std::size_t k = 0; k < coarse.segments.size(); ++k) {
    const CoarseMesh::Box& box = coarse.segment_boxes[k];
    if (box.i0 == box.i1 || box.j0 == box.j1) continue;
    ++slanting;
    EXPECT_FALSE(cut.leaves_out(coarse.segments[k], box, LargestDistances{}));
    EXPECT_TRUE(cut.leaves_out(coarse.segments[k], box, beyond));
    segments += cut.leaves_out(coarse.segments[k], box, most) ? 1 : 0;
  }
  EXPECT_GE(segments, slanting * 9 / 10);
  // A piece that reaches beyond the tile is never left out.
  const OverlayCut beside(coarse, fine, 1, 0);
  for (std::size_t k = 0; k < coarse.triangles.size(); ++k) {
    if (coarse.triangle_boxes[k].i0 > 0) continue;
    EXPECT_FALSE(beside.leaves_out(coarse.triangles[k], coarse.triangle_boxes[k], beyond));
  }
}

}  // namespace

}  // namespace lod
