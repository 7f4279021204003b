// Border posts depend on the edge only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lod/mesh/mesh.h"
#include "tests/lod/mesh_terrain.h"
#include "tests/support/support.h"

namespace lod {

namespace {

using lod_test::kRadius;
using lod_test::Terrain;

std::vector<int> mirrored(std::vector<int> kept, int intervals) {
  for (int& k : kept) k = intervals - k;
  std::reverse(kept.begin(), kept.end());
  return kept;
}

TEST(MeshBorder, ReversingTheEdgeMirrorsTheChoice) {
  test_support::Random random(3);
  for (int round = 0; round < 400; ++round) {
    const int level = random.integer(0, 9);
    const int n = 1 << random.integer(1, 8);
    const TileKey key{mars::Face::kPlusX, level, random.integer(0, (1 << level) - 1), 0};
    std::vector<double> line = grid_lines(key, n).u;
    // Few distinct heights, symmetric ones included, give many ties.
    const int steps = random.integer(0, 4);
    std::vector<double> height(line.size());
    for (double& h : height) h = 500.0 * random.integer(0, steps);
    if (round % 3 == 0) {
      for (std::size_t k = 0; k < height.size(); ++k) height[k] = height[std::min(k, height.size() - 1 - k)];
    }
    const double tolerance = random.log_uniform(0.1, 1000.0);
    const std::vector<int> forward = choose_border(height, line, -1.0, tolerance, kRadius);
    std::reverse(height.begin(), height.end());
    std::reverse(line.begin(), line.end());
    for (double& u : line) u = -u;
    ASSERT_EQ(mirrored(choose_border(height, line, 1.0, tolerance, kRadius), n), forward) << "round " << round;
  }
}

TEST(MeshBorder, EveryPostWithinToleranceAndNoneForNothing) {
  const GridLines lines = grid_lines({mars::Face::kPlusY, 6, 9, 9}, 128);
  test_support::Random random(8);
  std::vector<double> height(129);
  double h = 0;
  for (double& value : height) value = h += random.uniform(-50, 50);
  const double across = lines.u[0];
  for (const double tolerance : {0.0, 1.0, 20.0, 100.0, 1e5}) {
    const std::vector<int> kept = choose_border(height, lines.v, across, tolerance, kRadius);
    ASSERT_EQ(kept.front(), 0);
    ASSERT_EQ(kept.back(), 128);
    for (std::size_t s = 0; s + 1 < kept.size(); ++s) {
      const auto a = static_cast<std::size_t>(kept[s]);
      const auto b = static_cast<std::size_t>(kept[s + 1]);
      for (std::size_t k = a + 1; k < b; ++k) {
        const auto w = [&](std::size_t q) { return inverse_depth(across, lines.v[q], height[q], kRadius); };
        const double f = (lines.v[k] - lines.v[a]) / (lines.v[b] - lines.v[a]);
        const double r = w(k) * (kRadius + height[k]) / (w(a) + f * (w(b) - w(a)));
        EXPECT_LE(std::abs(r - kRadius - height[k]), tolerance + 1e-8);
      }
    }
    if (tolerance == 1e5) {
      EXPECT_EQ(kept.size(), 2U);
    }
  }
}

// All tiles of levels 0 to 2, and of 5 along the borders of the faces: every cube edge and corner of both
// kinds.
TEST(MeshBorder, NeighboursChooseTheSamePosts) {
  Terrain terrain(4, 4000, 2e6);
  terrain.add_craters({0.577, 0.577, 0.577}, 0.3, 40, 1e5, 4e5);
  int compared = 0;
  for (const int level : {0, 1, 2, 5}) {
    const int n = 16;
    const int tiles = 1 << level;
    const double tolerance = 0.002 * nominal_side_m(level, kRadius);
    for (int face = 0; face < mars::kFaces; ++face) {
      for (int j = 0; j < tiles; ++j) {
        for (int i = 0; i < tiles; ++i) {
          const bool rim = i == 0 || j == 0 || i == tiles - 1 || j == tiles - 1;
          const bool near_corner = std::min(i, tiles - 1 - i) < 2 && std::min(j, tiles - 1 - j) < 2;
          if (level == 5 && !(rim && near_corner)) continue;
          const TileKey key{static_cast<mars::Face>(face), level, i, j};
          const Posts posts = terrain.posts(key, n);
          const BorderPosts borders = choose_borders(posts, tolerance, kRadius);
          const TileMesh mesh = mesh_greedy(posts, borders, tolerance, kRadius);
          for (const Edge edge : kEdges) {
            const Neighbour other = neighbour(key, edge);
            const BorderPosts theirs = choose_borders(terrain.posts(other.key, n), tolerance, kRadius);
            const std::vector<int>& kept = theirs[static_cast<std::size_t>(other.edge)];
            ASSERT_EQ(other.reversed ? mirrored(kept, n) : kept, borders[static_cast<std::size_t>(edge)])
                << to_string(key) << " and " << to_string(other.key);
            std::vector<int> used;
            for (const MeshVertex& v : mesh.vertices) {
              if (edge == Edge::kWest && v.i == 0) used.push_back(v.j);
              if (edge == Edge::kEast && v.i == n) used.push_back(v.j);
              if (edge == Edge::kSouth && v.j == 0) used.push_back(v.i);
              if (edge == Edge::kNorth && v.j == n) used.push_back(v.i);
            }
            ASSERT_EQ(used, borders[static_cast<std::size_t>(edge)]);
            ++compared;
          }
        }
      }
    }
  }
  EXPECT_EQ(compared, 4 * (6 + 24 + 96 + 6 * 12));
}

}  // namespace

}  // namespace lod
