#include "lod/mesh/grid_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/lod/mesh_terrain.h"
#include "tests/support/support.h"

namespace lod {

namespace {

using lod_test::kRadius;

Posts ground(const TileKey& key, int intervals, std::uint64_t seed, double spacing_m) {
  const double side = nominal_side_m(3, kRadius);
  lod_test::Terrain terrain(seed, 0.01 * side, side, 0.8);
  Posts posts = terrain.posts(key, intervals);
  // Finer levels add noise at the scale of their posts, as real ground does.
  test_support::Random random(seed + static_cast<std::uint64_t>(pack(key)) % 1000);
  for (double& h : posts.height_m) h += random.uniform(-0.1, 0.1) * spacing_m;
  return posts;
}

TileKey random_key(test_support::Random& random, int level) {
  return {static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, (1 << level) - 1),
          random.integer(0, (1 << level) - 1)};
}

// The mesh of the same facets, measured over the whole overlay, is the reference.
TEST(GridMeter, StatesWhatTheOverlayOfTheFullGridHas) {
  test_support::Random random(20261122);
  constexpr int kIntervals = 32;
  double loosest = 1;
  for (int n = 0; n < 200; ++n) {
    const TileKey key = random_key(random, random.integer(0, 12));
    TileKey below = key;
    for (int d = random.integer(0, 7); d > 0; --d) below = child(below, random.integer(0, 3));
    const auto seed = static_cast<std::uint64_t>(random.integer(0, 1000));
    const Posts posts = ground(key, kIntervals, seed, post_spacing_m(key.level, kIntervals, kRadius));
    const Posts fine = ground(below, kIntervals, seed, post_spacing_m(below.level, kIntervals, kRadius));
    const TileMesh mesh = mesh_full(kIntervals);
    const ErrorTerms want =
        ErrorMeter(key, mesh, vertex_heights(mesh, posts), kRadius).measure(FinePosts(fine, kRadius));
    const ErrorTerms got = GridMeter(posts, kRadius).measure(FinePosts(fine, kRadius));
    const auto check = [&](double stated, double true_m, const char* what) {
      const double rounding = 3e-15 * 1.1 * kRadius;
      EXPECT_GE(stated, true_m * (1 - 1e-12) - rounding) << what << " of " << to_string(below);
      if (true_m > 1e-3) loosest = std::max(loosest, stated / true_m);
    };
    check(got.total_m, want.total_m, "total");
    check(got.height_error_m, want.height_error_m, "height error");
    check(got.sagitta_m, want.sagitta_m, "sagitta");
  }
  EXPECT_LE(loosest, 1.1);
  RecordProperty("loosest", std::to_string(loosest));
}

// A ridge between the coarse posts, on S only, has the measured height.
TEST(GridMeter, FindsARidgeBetweenPosts) {
  const TileKey key{mars::Face::kPlusX, 9, 100, 300};
  const Posts flat = lod_test::make_posts(key, 64, [](int, int) { return 0.0; });
  const GridMeter meter(flat, kRadius);
  for (int c = 0; c < 4; ++c) {
    const Posts ridge =
        lod_test::make_posts(child(key, c), 64, [](int i, int) { return i == 33 ? 250.0 : 0.0; });
    EXPECT_NEAR(meter.measure(FinePosts(ridge, kRadius)).height_error_m, 250.0, 2.0);
  }
}

TEST(GridMeter, ItsOwnPostsHaveNoError) {
  for (const int level : {0, 4, 9}) {
    const TileKey key{mars::Face::kMinusZ, level, (1 << level) / 2, 0};
    const Posts posts = ground(key, 32, 2, 1.0);
    const ErrorTerms terms = GridMeter(posts, kRadius).measure(FinePosts(posts, kRadius));
    EXPECT_LE(terms.sagitta_m, 2e-8);
    EXPECT_LE(terms.total_m, 2e-8);
    EXPECT_LE(terms.height_error_m, 4e-8);
  }
}

TEST(GridMeter, RefusesWhatDoesNotFit) {
  const TileKey key{mars::Face::kPlusX, 3, 2, 2};
  const auto flat = [](const TileKey& k, int n) {
    return lod_test::make_posts(k, n, [](int, int) { return 0.0; });
  };
  const GridMeter meter(flat(key, 16), kRadius);
  EXPECT_THROW(meter.measure(FinePosts(flat({mars::Face::kPlusX, 3, 3, 2}, 16), kRadius)),
               std::invalid_argument);
  EXPECT_THROW(meter.measure(FinePosts(flat(parent(key), 16), kRadius)), std::invalid_argument);
  EXPECT_THROW(meter.measure(FinePosts(flat(key, 8), kRadius)), std::invalid_argument);
  EXPECT_THROW(meter.measure(FinePosts(flat(key, 16), 2 * kRadius)), std::invalid_argument);
}

}  // namespace

}  // namespace lod
