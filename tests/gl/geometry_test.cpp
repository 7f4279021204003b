// Geometry for OpenGL and its certificate. Needs no context.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "lod/mesh/mesh.h"
#include "lod/tree/posts.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"
#include "vpe/core/frame.h"
#include "vpe/gl/certify.h"
#include "vpe/gl/tile_geometry.h"
#include "vpe/gl/tile_id.h"

namespace {

using test_support::Random;
using vpe::gl::make_geometry;
using vpe::gl::TileGeometry;

constexpr double kRadius_m = 3396190.0;
constexpr int kIntervals = 16;
const lod::TileKey kKey{mars::Face::kPlusY, 9, 137, 300};

std::vector<double> heights_of(double (*height)(int, int)) {
  std::vector<double> out;
  for (int j = 0; j <= kIntervals; ++j) {
    for (int i = 0; i <= kIntervals; ++i) out.push_back(height(i, j));
  }
  return out;
}

glm::dvec3 place(int i, int j, double height_m) {
  const lod::GridLines lines = lod::grid_lines(kKey, kIntervals);
  return mars::chart_direction(kKey.face, lines.u[static_cast<std::size_t>(i)],
                               lines.v[static_cast<std::size_t>(j)]) *
         (kRadius_m + height_m);
}

TEST(TileGeometryTest, VerticesAreWithinTheStatedRoundingOfTheirPlaces) {
  Random random(31);
  std::vector<double> heights = heights_of([](int, int) { return 0.0; });
  for (double& h : heights) h = random.uniform(-3000, 5000);
  const lod::TileMesh mesh = lod::mesh_full(kIntervals);
  for (const int origin : {vpe::gl::kTileCentre, 0, 5 * (kIntervals + 1) + 11}) {
    const TileGeometry g = make_geometry(kKey, mesh, heights, kRadius_m, {1.5, origin});
    ASSERT_EQ(g.surface_vertices, mesh.vertices.size());
    double worst = 0;
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
      const glm::dvec3 exact = place(mesh.vertices[n].i, mesh.vertices[n].j, 1.5 * heights[n]);
      const glm::dvec3 stored = g.centre_m + glm::dvec3(g.positions_m[n]);
      const double error = glm::length(stored - exact);
      worst = std::max(worst, error);
      ASSERT_LE(error, g.quantisation_m + 1e-9);
      // certify() takes this bound near the camera.
      ASSERT_LE(error, std::ldexp(glm::length(exact - g.centre_m), -24) + 1e-9);
    }
    EXPECT_GE(worst, 0.99 * g.quantisation_m - 1e-9);
  }
}

TEST(TileGeometryTest, AnOriginNearTheCameraIsExactThere) {
  const std::vector<double> heights = heights_of([](int i, int j) { return 13.7 * i - 4.1 * j; });
  const lod::TileMesh mesh = lod::mesh_full(kIntervals);
  const int origin = 7 * (kIntervals + 1) + 3;
  const TileGeometry g = make_geometry(kKey, mesh, heights, kRadius_m, {1.0, origin});
  EXPECT_LT(glm::length(g.centre_m - place(3, 7, 13.7 * 3 - 4.1 * 7)), 1e-6);
  const auto at = static_cast<std::size_t>(origin);
  EXPECT_EQ(g.positions_m[at], glm::vec3(0, 0, 0));
}

TEST(TileGeometryTest, NormalsAreThoseOfTheVerticesAndOfTheFeetBelow) {
  const lod::TileMesh mesh = lod::mesh_full(kIntervals);
  const std::vector<double> heights = heights_of([](int i, int j) { return 10.0 * (i ^ j); });
  EXPECT_TRUE(make_geometry(kKey, mesh, heights, kRadius_m, {}).normals.empty());
  Random random(33);
  std::vector<glm::vec3> normals;
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) normals.emplace_back(random.direction());
  const TileGeometry with =
      make_geometry(kKey, mesh, heights, kRadius_m, {1.0, vpe::gl::kTileCentre, true, normals});
  const TileGeometry without = make_geometry(kKey, mesh, heights, kRadius_m, {});
  ASSERT_EQ(with.normals.size(), with.positions_m.size());
  EXPECT_EQ(with.positions_m, without.positions_m);
  EXPECT_EQ(with.indices, without.indices);
  for (std::size_t n = 0; n < normals.size(); ++n) ASSERT_EQ(with.normals[n], vpe::gl::pack_normal(normals[n]));
  for (std::uint32_t n = with.ranges.skirts[0]; n < with.ranges.skirts[4]; n += 4)
    for (std::uint32_t k = 0; k < 2; ++k)
      ASSERT_EQ(with.normals[with.indices[n + k]], with.normals[with.indices[n + 2 + k]]);
  EXPECT_GE(with.bytes(), without.bytes() + 4 * with.positions_m.size());
}

TEST(TileGeometryTest, PackedNormalsAreWithinTheStatedAngle) {
  Random random(34);
  const auto expect_same = [](const glm::dvec3& d) {
    const glm::vec3 back = vpe::gl::unpack_normal(vpe::gl::pack_normal(glm::vec3(d)));
    ASSERT_LT(glm::length(glm::dvec3(back) - d), 1e-4) << d.x << " " << d.y << " " << d.z;
    ASSERT_NEAR(glm::length(back), 1, 1e-6);
  };
  for (int n = 0; n < 200000; ++n) expect_same(random.direction());
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0})
      for (const double z : {-1.0, 0.0, 1.0})
        if (x != 0 || y != 0 || z != 0) expect_same(glm::normalize(glm::dvec3(x, y, z)));
}

TEST(TileGeometryTest, TheLongestEdgeIsTheDiagonalOfACell) {
  const lod::TileMesh mesh = lod::mesh_full(kIntervals);
  const TileGeometry flat = make_geometry(kKey, mesh, heights_of([](int, int) { return 0.0; }), kRadius_m, {});
  const double east_m = glm::length(place(9, 8, 0) - place(8, 8, 0));
  EXPECT_NEAR(flat.longest_edge_m, std::hypot(east_m, glm::length(place(8, 9, 0) - place(8, 8, 0))),
              0.05 * east_m);
}

TEST(TileGeometryTest, BordersHaveALineAndASkirtForEachPiece) {
  const lod::TileMesh mesh = lod::mesh_full(kIntervals);
  const TileGeometry g =
      make_geometry(kKey, mesh, heights_of([](int i, int j) { return 10.0 * (i ^ j); }), kRadius_m, {});
  EXPECT_EQ(g.ranges.surface, mesh.triangles.size());
  EXPECT_EQ(g.ranges.border_end, g.indices.size());
  EXPECT_EQ(g.ranges.border_end - g.ranges.skirts[4], 2U * 4 * kIntervals);
  for (std::size_t e = 0; e < 4; ++e) {
    ASSERT_EQ(g.ranges.skirts[e + 1] - g.ranges.skirts[e], 4U * kIntervals);
    for (std::uint32_t n = g.ranges.skirts[e]; n < g.ranges.skirts[e + 1]; n += 4) {
      for (std::uint32_t k = 0; k < 2; ++k) {
        const std::uint32_t top = g.indices[n + k];
        const std::uint32_t foot = g.indices[n + 2 + k];
        ASSERT_LT(top, g.surface_vertices);
        ASSERT_GE(foot, g.surface_vertices);
        ASSERT_EQ(g.positions_m[top], g.positions_m[foot]);
      }
    }
  }
}

// A point of a triangle, whose corners are rounded by storage and by the subtraction of the camera, moves by no
// more than is certified; and the certified figure is at most some tens of times the movement.
TEST(Certify, BoundsWhatStorageMoves) {
  Random random(32);
  const lod::TileTree tree = fake::tree(fake::rough(3, 5));
  double tightest = 1e9;
  for (int trial = 0; trial < 20000; ++trial) {
    const glm::dvec3 up = random.direction();
    const glm::dvec3 camera = up * (kRadius_m + random.log_uniform(1, 1e5));
    const double distance_m = random.log_uniform(0.1, 1e6);
    const glm::dvec3 point = camera + distance_m * random.direction();
    const double edge_m = random.log_uniform(1, 1e5);
    const double away_m = random.log_uniform(0.01, 1e5);
    const glm::dvec3 centre = point + away_m * random.direction();
    std::array<glm::dvec3, 3> corners;
    for (glm::dvec3& c : corners) c = point + 0.5 * edge_m * random.direction();
    std::array<double, 3> weights{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
    const double sum = weights[0] + weights[1] + weights[2];
    glm::dvec3 exact(0);
    glm::dvec3 drawn(0);
    double quantisation_m = 0;
    const glm::vec3 to_camera(centre - camera);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 stored(corners[k] - centre);
      quantisation_m = std::max(quantisation_m, glm::length(glm::dvec3(stored) - (corners[k] - centre)));
      exact += weights[k] / sum * (corners[k] - camera);
      drawn += weights[k] / sum * glm::dvec3(stored + to_camera);
    }
    lod::SelectedTile tile;
    tile.key = tree[0].key;
    tile.min_distance_m = glm::length(exact);
    const vpe::gl::CertifiedTile certified{&tile, quantisation_m, edge_m, glm::length(centre - camera), 0};
    constexpr double kFocal_px = 600;
    const auto c = vpe::gl::certify({&certified, 1}, tree, 32, {kFocal_px, 0.001, 0, 1});
    const double moved_px = glm::length(drawn - exact) * kFocal_px / glm::length(exact);
    ASSERT_LE(moved_px, c.shift_bound_px) << "trial " << trial;
    ASSERT_EQ(c.quantisation_px, c.shift_bound_px);
    if (moved_px > 0) tightest = std::min(tightest, c.shift_bound_px / moved_px);
  }
  EXPECT_LT(tightest, 5);
}

TEST(Certify, AddsTheTermsOfTheWorstTile) {
  std::vector<lod::TileInfo> infos;
  for (int f = 0; f < 6; ++f) {
    const double slope = f == 1 ? std::sqrt(15.0) : 0.5;
    infos.push_back({{static_cast<mars::Face>(f), 0, 0, 0}, 0, 0, false, {}, {{{}, 32}}, slope});
  }
  const lod::TileTree tree(infos, {2}, kRadius_m);
  lod::SelectedTile near;
  near.key = tree[0].key;
  near.geometric_error_m = 3;
  near.screen_space_error_px = 0.9;
  near.min_distance_m = 2000;
  lod::SelectedTile far = near;
  far.index = 1;
  far.key = tree[1].key;
  far.geometric_error_m = 50;
  far.screen_space_error_px = 0.2;
  far.min_distance_m = 2e5;
  const std::array<vpe::gl::CertifiedTile, 2> tiles{{{&near, 1e-9, 100, 0, 0}, {&far, 1e-9, 100, 0, 0}}};
  const auto c = vpe::gl::certify(tiles, tree, 32, {1000, 0.5, 0.02, 1});
  EXPECT_EQ(c.tiles_drawn, 2);
  EXPECT_EQ(c.geometric_error_m, 50);
  EXPECT_EQ(c.screen_space_error_px, 0.9);
  // The shares of the grid step and of storage for the steepest ground of the image, over the nearer tile's error.
  const double stored_px = (1e-9 + 4e-7 * (2000 + 100)) * 1000 / 2000;
  EXPECT_NEAR(c.shift_bound_px, 0.9 + (0.02 + stored_px) * 4, 1e-12);
  const auto twice = vpe::gl::certify(tiles, tree, 32, {1000, 0.5, 0.02, 2});
  EXPECT_NEAR(twice.shift_bound_px, 0.9 + (0.02 + stored_px) * std::sqrt(61.0), 1e-12);
  EXPECT_EQ(twice.exaggeration, 2);
}

TEST(Certify, BoundsPartsWhereTheyAppear) {
  std::vector<lod::TileInfo> infos;
  for (int f = 0; f < 6; ++f)
    infos.push_back({{static_cast<mars::Face>(f), 0, 0, 0}, 0, 0, false, {}, {{{}, 32}}, std::sqrt(15.0)});
  const lod::TileTree tree(infos, {2}, kRadius_m);
  lod::SelectedTile hidden;  // worst of all, and nowhere in the image
  hidden.key = tree[0].key;
  hidden.geometric_error_m = 500;
  hidden.screen_space_error_px = 50;
  hidden.min_distance_m = 10000;
  lod::SelectedTile seen = hidden;
  seen.index = 1;
  seen.key = tree[1].key;
  seen.geometric_error_m = 2;
  seen.screen_space_error_px = 20;
  seen.min_distance_m = 100;  // of a point that is not visible
  const std::array<vpe::gl::CertifiedTile, 2> tiles{{{&hidden, 1e-9, 100, 0, 0}, {&seen, 1e-9, 100, 0, 6}}};
  using vpe::gl::TilePart;
  const auto bound = [&](TilePart part, float near_m, float far_m) {
    const std::array<std::uint32_t, 3> ids{vpe::gl::kNoTile, vpe::gl::pack({1, part}),
                                           vpe::gl::pack({1, TilePart::kSurface})};
    const std::array<float, 3> ranges{vpe::core::kSkyRange, near_m, far_m};
    return vpe::gl::bound_in_image(tiles, tree, {ids, ranges, 1e-6}, {1000, 0.5, 0.02, 1});
  };
  const double moved_px = 0.02 + (1e-9 + 4e-7 * (4000 + 100)) * 1000 / 4000;
  EXPECT_NEAR(bound(TilePart::kSurface, 4000, 8000), 2.0 / 4 + moved_px * 4, 1e-5);
  EXPECT_NEAR(bound(TilePart::kRibbon, 4000, 8000), 2.0 / 4 + moved_px * 4, 1e-5);
  EXPECT_NEAR(bound(TilePart::kSkirt, 4000, 8000), (2.0 + 6.0) / 4 + moved_px * 4, 1e-5);
  EXPECT_NEAR(bound(TilePart::kSkirt, 32000, 4000), 2.0 / 4 + moved_px * 4, 1e-5);
  // Ranges are known no better than their stated error.
  EXPECT_GT(bound(TilePart::kSurface, 4000, 4e9F), bound(TilePart::kSurface, 4000, 8000) - 1e-12);
  EXPECT_EQ(vpe::gl::bound_in_image(tiles, tree, {}, {1000, 0.5, 0.02, 1}), 0);
}

TEST(TileId, SurvivesColours) {
  std::uint32_t before = vpe::gl::kNoTile;
  for (const std::size_t tile : {0U, 1U, 84U, 85U, 86U, 4095U, 70000U, (1U << 22U) - 1U}) {
    for (const auto part :
         {vpe::gl::TilePart::kSurface, vpe::gl::TilePart::kRibbon, vpe::gl::TilePart::kSkirt}) {
      const std::uint32_t id = vpe::gl::pack({tile, part});
      EXPECT_GT(id, before);
      before = id;
      const auto rgb = vpe::gl::id_colour(id);
      const auto back = vpe::gl::unpack(vpe::gl::id_of_colour(rgb[0], rgb[1], rgb[2]));
      EXPECT_EQ(back.tile, tile);
      EXPECT_EQ(back.part, part);
    }
  }
}

}  // namespace
