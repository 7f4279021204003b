// Greedy meshes: valid, within tolerance, Delaunay, deterministic, the same from another half-edge structure.
#include "lod/mesh/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "tests/lod/mesh_terrain.h"
#include "tests/lod/mesh_twin.h"
#include "tests/support/support.h"

namespace lod {

namespace {

using lod_test::kRadius;
using lod_test::make_posts;
using lod_test::Terrain;
__extension__ using Wide = __int128;

BorderPosts full_borders(int intervals) {
  std::vector<int> all(static_cast<std::size_t>(intervals) + 1);
  std::iota(all.begin(), all.end(), 0);
  return {all, all, all, all};
}

BorderPosts corners(int intervals) {
  const std::vector<int> ends{0, intervals};
  return {ends, ends, ends, ends};
}

// Returns exact chart coordinates from the public face_line() alone, or grid indices where the grid is even.
struct Exact {
  std::vector<std::int64_t> x, y;
  Exact(const TileKey& key, int intervals) {
    const GridLines lines = grid_lines(key, intervals);
    for (int k = 0; k <= intervals; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const bool even = key.level >= 5;
      x.push_back(even ? k : std::llround(std::ldexp(lines.u[at], 30)));
      y.push_back(even ? k : std::llround(std::ldexp(lines.v[at], 30)));
    }
  }
};

Wide turn(const Exact& e, MeshVertex a, MeshVertex b, MeshVertex c) {
  return static_cast<Wide>(e.x[b.i] - e.x[a.i]) * (e.y[c.j] - e.y[a.j]) -
         static_cast<Wide>(e.y[b.j] - e.y[a.j]) * (e.x[c.i] - e.x[a.i]);
}

Wide in_circle(const Exact& e, MeshVertex a, MeshVertex b, MeshVertex c, MeshVertex d) {
  const auto row = [&](MeshVertex p) {
    const Wide x = e.x[p.i] - e.x[d.i];
    const Wide y = e.y[p.j] - e.y[d.j];
    return std::array{x, y, x * x + y * y};
  };
  const auto [ax, ay, aa] = row(a);
  const auto [bx, by, bb] = row(b);
  const auto [cx, cy, cc] = row(c);
  return aa * (bx * cy - by * cx) + bb * (cx * ay - cy * ax) + cc * (ax * by - ay * bx);
}

// Expects all properties that a mesh must have for any heights.
void expect_valid(const TileKey& key, const TileMesh& mesh, const BorderPosts& borders) {
  const int n = mesh.intervals;
  const Exact e(key, n);
  ASSERT_TRUE(std::is_sorted(mesh.vertices.begin(), mesh.vertices.end(), [](MeshVertex a, MeshVertex b) {
    return std::pair(a.j, a.i) < std::pair(b.j, b.i);
  }));
  ASSERT_EQ(std::set(mesh.vertices.begin(), mesh.vertices.end()).size(), mesh.vertices.size());
  Wide area = 0;
  std::map<std::pair<int, int>, int> apex;  // of the triangle on the left of a directed edge
  std::vector<bool> used(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::array<int, 3> c{mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]};
    ASSERT_LT(c[0], std::min(c[1], c[2]));
    const auto vertex = [&](int k) {
      return mesh.vertices[static_cast<std::size_t>(c[static_cast<std::size_t>(k)])];
    };
    const Wide twice = turn(e, vertex(0), vertex(1), vertex(2));
    ASSERT_GT(twice, 0);
    area += twice;
    for (std::size_t k = 0; k < 3; ++k) {
      used[static_cast<std::size_t>(c[k])] = true;
      ASSERT_TRUE(apex.emplace(std::pair(c[k], c[(k + 1) % 3]), c[(k + 2) % 3]).second);
    }
  }
  EXPECT_TRUE(area == 2 * static_cast<Wide>(e.x.back() - e.x.front()) * (e.y.back() - e.y.front()));
  EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool b) { return b; }));

  BorderPosts found;
  std::size_t border_edges = 0;
  for (const auto& [edge, opposite] : apex) {
    const auto& [from, to] = edge;
    const auto other = apex.find({to, from});
    if (other == apex.end()) {
      ++border_edges;
      continue;
    }
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(k)]; };
    const Wide inside = in_circle(e, at(from), at(to), at(opposite), at(other->second));
    ASSERT_TRUE(inside <= 0) << "edge " << from << ' ' << to << " is not Delaunay";
    if (inside == 0) {
      ASSERT_LT(std::min(from, to), std::min(opposite, other->second)) << "diagonal of a co-circular quad";
    }
  }
  for (const MeshVertex& v : mesh.vertices) {
    if (v.i == 0) found[static_cast<std::size_t>(Edge::kWest)].push_back(v.j);
    if (v.i == n) found[static_cast<std::size_t>(Edge::kEast)].push_back(v.j);
    if (v.j == 0) found[static_cast<std::size_t>(Edge::kSouth)].push_back(v.i);
    if (v.j == n) found[static_cast<std::size_t>(Edge::kNorth)].push_back(v.i);
  }
  EXPECT_EQ(found, borders);
  // Euler: a disc has V - E + F = 1, and 2 E = 3 F + border.
  EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangle_count() + border_edges + 2);
}

// Returns the largest distance of interior posts from the triangles over them, by barycentric coordinates.
double worst_post_m(const TileMesh& mesh, const Posts& posts) {
  const GridLines lines = grid_lines(posts.key, posts.intervals);
  const auto depth = [&](int i, int j) {
    return static_cast<long double>(inverse_depth(
        lines.u[static_cast<std::size_t>(i)], lines.v[static_cast<std::size_t>(j)], posts.at(i, j), kRadius));
  };
  const Exact e(posts.key, posts.intervals);
  double worst = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const MeshVertex a = mesh.vertices[mesh.triangles[t]];
    const MeshVertex b = mesh.vertices[mesh.triangles[t + 1]];
    const MeshVertex c = mesh.vertices[mesh.triangles[t + 2]];
    const auto [i0, i1] = std::minmax({a.i, b.i, c.i});
    const auto [j0, j1] = std::minmax({a.j, b.j, c.j});
    for (std::uint16_t j = j0; j <= j1; ++j) {
      for (std::uint16_t i = i0; i <= i1; ++i) {
        if (i == 0 || j == 0 || i == mesh.intervals || j == mesh.intervals) continue;
        const MeshVertex p{i, j};
        const Wide la = turn(e, p, b, c);
        const Wide lb = turn(e, a, p, c);
        const Wide lc = turn(e, a, b, p);
        if (la < 0 || lb < 0 || lc < 0) continue;
        const long double w =
            (static_cast<long double>(la) * depth(a.i, a.j) + static_cast<long double>(lb) * depth(b.i, b.j) +
             static_cast<long double>(lc) * depth(c.i, c.j)) /
            static_cast<long double>(la + lb + lc);
        const long double r = kRadius + static_cast<long double>(posts.at(i, j));
        worst = std::max(worst, static_cast<double>(std::abs(depth(i, j) * r / w - r)));
      }
    }
  }
  return worst;
}

TileKey middle_tile(mars::Face face, int level) {
  return {face, level, (1 << level) * 5 / 8, (1 << level) * 3 / 8};
}

Posts rough(const TileKey& key, int intervals, std::uint64_t seed) {
  const double side = nominal_side_m(key.level, kRadius);
  Terrain terrain(seed, 0.02 * side, side);
  terrain.add_craters(bounding_cap(key).centre, bounding_cap(key).radius_rad, 30, side / 30, side / 5);
  return terrain.posts(key, intervals);
}

TEST(MeshGreedy, IsValidDelaunayAndWithinTolerance) {
  for (const int level : {0, 1, 3, 4, 5, 9}) {
    const TileKey key = middle_tile(mars::Face::kMinusY, level);
    const Posts posts = rough(key, level == 4 ? 64 : 32, 11);
    for (const double share : {0.02, 0.003, 0.0003}) {
      const double tolerance = share * nominal_side_m(level, kRadius);
      const BorderPosts borders = choose_borders(posts, tolerance, kRadius);
      const TileMesh mesh = mesh_greedy(posts, borders, tolerance, kRadius);
      SCOPED_TRACE(testing::Message() << "level " << level << " tolerance " << tolerance << ": "
                                      << mesh.vertices.size() << " vertices");
      expect_valid(key, mesh, borders);
      EXPECT_LE(worst_post_m(mesh, posts), tolerance + 1e-8);
    }
  }
}

TEST(MeshGreedy, StopsAsSoonAsItMay) {
  // The last inserted post was worse than the tolerance, so a slightly larger tolerance omits it.
  const Posts posts = rough(middle_tile(mars::Face::kPlusX, 6), 64, 5);
  std::size_t vertices = 65 * 65 + 1;
  for (double tolerance = 1; tolerance < 2000; tolerance *= 1.3) {
    const TileMesh mesh = mesh_greedy(posts, corners(64), tolerance, kRadius);
    EXPECT_LE(mesh.vertices.size(), vertices);
    vertices = mesh.vertices.size();
  }
  EXPECT_LT(vertices, 200U);
}

TEST(MeshGreedy, SameFromAnotherHalfEdgeStructure) {
  GreedyMesher<lod_test::ArrayTopology> twin;
  Mesher mesher;
  for (int level = 0; level <= 8; ++level) {
    const TileKey key = middle_tile(mars::Face::kPlusZ, level);
    const Posts posts = rough(key, 64, static_cast<std::uint64_t>(level));
    for (const double share : {0.01, 0.001, 0.0001}) {
      const double tolerance = share * nominal_side_m(level, kRadius);
      const BorderPosts borders = choose_borders(posts, tolerance, kRadius);
      const TileMesh one = mesher.mesh(posts, borders, tolerance, kRadius);
      const TileMesh two = twin.mesh(posts, borders, tolerance, kRadius);
      ASSERT_EQ(one.vertices, two.vertices);
      ASSERT_EQ(one.triangles, two.triangles);
    }
  }
}

TEST(MeshGreedy, ScratchMemoryLeavesNoTrace) {
  Mesher used;
  for (const int level : {7, 2, 7, 0}) {
    const Posts posts = rough(middle_tile(mars::Face::kPlusY, level), level == 2 ? 16 : 64, 3);
    const double tolerance = 0.001 * nominal_side_m(level, kRadius);
    const BorderPosts borders = choose_borders(posts, tolerance, kRadius);
    const TileMesh again = used.mesh(posts, borders, tolerance, kRadius);
    const TileMesh fresh = mesh_greedy(posts, borders, tolerance, kRadius);
    EXPECT_EQ(again.vertices, fresh.vertices);
    EXPECT_EQ(again.triangles, fresh.triangles);
  }
}

TEST(MeshGreedy, LevelGroundIsTwoTriangles) {
  for (const int k : {4, 5, 6, 7, 8}) {
    const TileKey key = middle_tile(mars::Face::kPlusX, 12);
    const TileMesh mesh =
        mesh_greedy(make_posts(key, 1 << k, [](int, int) { return 1234.5; }), corners(1 << k), 1.0, kRadius);
    EXPECT_EQ(mesh.triangle_count(), 2U);
    expect_valid(key, mesh, corners(1 << k));
  }
}

TEST(MeshGreedy, OneSpike) {
  for (const double height : {1e6, -1e6, 3.4e7}) {  // 10 planet radii
    const TileKey key = middle_tile(mars::Face::kPlusX, 12);
    const Posts posts = make_posts(key, 64, [&](int i, int j) { return i == 21 && j == 40 ? height : 0.0; });
    const TileMesh mesh = mesh_greedy(posts, corners(64), 1.0, kRadius);
    expect_valid(key, mesh, corners(64));
    EXPECT_TRUE(std::count(mesh.vertices.begin(), mesh.vertices.end(), MeshVertex{21, 40}));
    EXPECT_LE(worst_post_m(mesh, posts), 1.0 + 1e-7);
  }
}

TEST(MeshGreedy, CheckerboardWantsEveryPostAndThenIsTheFullGrid) {
  for (const int level : {0, 4, 7}) {
    for (const int k : {4, 5, 6, 7}) {
      const TileKey key = middle_tile(mars::Face::kMinusX, level);
      const double side = nominal_side_m(level, kRadius);
      const Posts posts =
          make_posts(key, 1 << k, [&](int i, int j) { return (i + j) % 2 ? 0.1 * side : -0.1 * side; });
      const TileMesh mesh = mesh_greedy(posts, full_borders(1 << k), 1e-3 * side, kRadius);
      ASSERT_EQ(mesh.vertices.size(), posts.height_m.size());
      expect_valid(key, mesh, full_borders(1 << k));
      // A square's four posts are co-circular where the grid is even, and the rule picks S's diagonal.
      if (level >= 5) {
        const TileMesh full = mesh_full(1 << k);
        std::set<std::array<int, 3>> want, have;
        for (std::size_t t = 0; t < full.triangles.size(); t += 3) {
          want.insert({full.triangles[t], full.triangles[t + 1], full.triangles[t + 2]});
          have.insert({mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]});
        }
        EXPECT_EQ(want, have);
      }
    }
  }
}

TEST(MeshGreedy, WildHeightsStayValid) {
  test_support::Random random(29);
  for (int round = 0; round < 12; ++round) {
    const int level = random.integer(0, 14);
    const int n = 1 << random.integer(2, 6);
    const TileKey key = middle_tile(mars::Face::kMinusZ, level);
    const double size = random.log_uniform(1e-3, 1e6);
    const Posts posts = make_posts(key, n, [&](int, int) { return random.uniform(-size, size); });
    const double tolerance = size * random.log_uniform(1e-6, 1.0);
    const BorderPosts borders = choose_borders(posts, tolerance, kRadius);
    const TileMesh mesh = mesh_greedy(posts, borders, tolerance, kRadius);
    expect_valid(key, mesh, borders);
    EXPECT_LE(worst_post_m(mesh, posts), tolerance * (1 + 1e-9) + 1e-7);
  }
}

TEST(MeshGreedy, StopsAtTheMostVerticesThatIndicesCanName) {
  const TileKey key = middle_tile(mars::Face::kPlusX, 9);
  const Posts posts = make_posts(key, 256, [](int i, int j) { return (i + j) % 2 ? 5.0 : -5.0; });
  const TileMesh mesh = mesh_greedy(posts, full_borders(256), 0.1, kRadius);
  EXPECT_EQ(mesh.vertices.size(), 65536U);
  EXPECT_EQ(mesh.vertices.back(), (MeshVertex{256, 256}));
}

TEST(MeshGreedy, RefusesBadBorders) {
  const Posts posts = make_posts(middle_tile(mars::Face::kPlusX, 9), 16, [](int, int) { return 0.0; });
  for (const std::vector<int>& bad :
       {std::vector<int>{}, {0}, {0, 15}, {1, 16}, {0, 5, 5, 16}, {0, 7, 3, 16}}) {
    BorderPosts borders = corners(16);
    borders[2] = bad;
    EXPECT_THROW(mesh_greedy(posts, borders, 1.0, kRadius), std::invalid_argument);
  }
}

TEST(MeshFull, IsTheGrid) {
  const TileMesh mesh = mesh_full(16);
  EXPECT_EQ(mesh.vertices.size(), 17U * 17U);
  EXPECT_EQ(mesh.triangle_count(), 2U * 16U * 16U);
  expect_valid(middle_tile(mars::Face::kPlusX, 6), mesh, full_borders(16));
  EXPECT_THROW(mesh_full(256), std::invalid_argument);
  EXPECT_THROW(mesh_full(0), std::invalid_argument);
}

}  // namespace

}  // namespace lod
