#include "vpe/gl/mesh_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <set>

#include "lod/tree/posts.h"
#include "mars/geodesy/pose.h"
#include "tests/support/support.h"
#include "vpe/gl/tile_geometry.h"

namespace {

using test_support::Random;
using vpe::gl::IndexRange;
using vpe::gl::TileGeometry;

constexpr double kRadius_m = 3396190.0;
constexpr int kIntervals = 64;

std::multiset<std::array<std::uint16_t, 3>> triangles_of(const lod::TileMesh& mesh) {
  std::multiset<std::array<std::uint16_t, 3>> out;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3)
    out.insert({mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]});
  return out;
}

TEST(MeshPieces, OrderingKeepsTheTrianglesAndJoinsThoseOfASquare) {
  const lod::TileMesh canonical = lod::mesh_full(kIntervals);
  lod::TileMesh mesh = canonical;
  vpe::gl::order_by_pieces(mesh);
  EXPECT_EQ(triangles_of(mesh), triangles_of(canonical));
  EXPECT_EQ(mesh.vertices, canonical.vertices);
  const int rows = vpe::gl::piece_rows(mesh.triangle_count());
  EXPECT_EQ(rows, 8);
  const std::vector<glm::vec3> nowhere(mesh.vertices.size(), glm::vec3(0));
  EXPECT_EQ(vpe::gl::mesh_pieces(mesh, nowhere, {}).size(), static_cast<std::size_t>(rows * rows));
  lod::TileMesh again = mesh;
  vpe::gl::order_by_pieces(again);
  EXPECT_EQ(again.triangles, mesh.triangles);
  lod::TileMesh few = lod::mesh_full(8);
  const lod::TileMesh before = few;
  vpe::gl::order_by_pieces(few);
  EXPECT_EQ(few.triangles, before.triangles);
}

struct Tile {
  lod::TileKey key;
  TileGeometry geometry;
};

Tile rough_tile(Random& random) {
  Tile tile;
  const int level = random.integer(3, 12);
  tile.key = {static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, (1 << level) - 1),
              random.integer(0, (1 << level) - 1)};
  lod::TileMesh mesh = lod::mesh_full(kIntervals);
  vpe::gl::order_by_pieces(mesh);
  std::vector<double> heights(mesh.vertices.size());
  for (double& h : heights) h = random.uniform(-3000, 3000);
  tile.geometry = vpe::gl::make_geometry(tile.key, mesh, heights, kRadius_m, {});
  return tile;
}

// Pieces that are left out have no triangle with a point in the image. The test draws triangles from many sides, near
// and far, and looks at the three corners and points between.
TEST(MeshPieces, WhatIsLeftOutIsOutsideOfTheImage) {
  Random random(81);
  std::size_t drawn = 0;
  std::size_t left = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const Tile tile = rough_tile(random);
    const TileGeometry& g = tile.geometry;
    const mars::ChartRect rect = lod::chart_rect(tile.key);
    const glm::dvec3 over =
        mars::chart_direction(rect.face, random.uniform(rect.u0, rect.u1), random.uniform(rect.v0, rect.v1));
    const mars::LonLat place = mars::lon_lat(over);
    vpe::core::View view;
    view.camera = mars::to_camera(
        mars::Pose{place.lon_deg, place.lat_deg, 3000 + random.log_uniform(1, 1e5), random.uniform(-180, 180),
                   random.uniform(-90, 20), random.uniform(-180, 180)},
        kRadius_m);
    view.fov_deg = random.log_uniform(1, 120);
    const vpe::gl::PieceView seen{cull::make_frustum(view), {}};
    std::vector<IndexRange> ranges;
    vpe::gl::seen_ranges(g.pieces, g.frame, seen, ranges);
    std::vector<bool> is_drawn(g.ranges.surface / 3);
    std::uint32_t end = 0;
    for (const IndexRange& range : ranges) {
      ASSERT_TRUE(end == 0 || range.begin > end);
      ASSERT_LT(range.begin, range.end);
      end = range.end;
      for (std::uint32_t t = range.begin / 3; t < range.end / 3; ++t) is_drawn[t] = true;
    }
    ASSERT_LE(end, g.ranges.surface);
    for (std::size_t t = 0; t < is_drawn.size(); ++t) {
      if (is_drawn[t]) {
        ++drawn;
        continue;
      }
      ++left;
      std::array<glm::dvec3, 3> corner;
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = g.centre_m + glm::dvec3(g.positions_m[g.indices[3 * t + k]]);
      for (const glm::dvec3& weight : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1),
                                       glm::dvec3(1, 1, 1) / 3.0, glm::dvec3(0.5, 0.5, 0)}) {
        const glm::dvec3 point = weight.x * corner[0] + weight.y * corner[1] + weight.z * corner[2];
        const vpe::core::Projected p = vpe::core::project(view, point);
        ASSERT_TRUE(p.behind || p.xy.x < 0 || p.xy.x > view.width || p.xy.y < 0 || p.xy.y > view.height);
      }
    }
  }
  EXPECT_GT(drawn, 20000U);
  EXPECT_GT(left, 200000U);
}

// Behind the horizon of a sphere: the ray to each corner of what is left out passes below the sphere.
TEST(MeshPieces, WhatTheHorizonHidesIsBehindTheSphere) {
  Random random(82);
  std::size_t left = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Tile tile = rough_tile(random);
    const TileGeometry& g = tile.geometry;
    const double occluder_m = kRadius_m - 4000;
    const glm::dvec3 camera =
        glm::normalize(glm::normalize(g.centre_m) + random.uniform(0, 1.5) * random.direction()) *
        (kRadius_m + random.log_uniform(100, 1e5));
    vpe::core::View view;
    view.camera.position_m = camera;
    const vpe::gl::PieceView seen{{camera, {}, 0}, cull::make_horizon(cull::make_camera(camera), occluder_m)};
    std::vector<IndexRange> ranges;
    vpe::gl::seen_ranges(g.pieces, g.frame, seen, ranges);
    std::vector<bool> is_drawn(g.ranges.surface);
    for (const IndexRange& range : ranges)
      std::fill(is_drawn.begin() + range.begin, is_drawn.begin() + range.end, true);
    for (std::size_t n = 0; n < is_drawn.size(); ++n) {
      const glm::dvec3 step = g.centre_m + glm::dvec3(g.positions_m[g.indices[n]]) - camera;
      if (is_drawn[n]) continue;
      ++left;
      const double at = std::clamp(-glm::dot(camera, step) / glm::dot(step, step), 0.0, 1.0);
      ASSERT_LT(glm::length(camera + at * step), occluder_m);
    }
  }
  EXPECT_GT(left, 10000U);
}

}  // namespace
