// Occluder profiles lie nowhere above the drawn triangles, and not far below them.
#include "lod/occluder_profile.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/lod/mesh_terrain.h"
#include "tests/support/support.h"

namespace {

using lod_test::kRadius;

struct Drawn {
  lod::TileKey key;
  lod::TileMesh mesh;
  std::vector<double> height_m;
};

Drawn meshed(const lod::Posts& posts, double tolerance_m) {
  lod::TileMesh mesh =
      lod::mesh_greedy(posts, lod::choose_borders(posts, tolerance_m, kRadius), tolerance_m, kRadius);
  std::vector<double> heights = lod::vertex_heights(mesh, posts);
  return {posts.key, std::move(mesh), std::move(heights)};
}

// Returns the height of the drawn triangles at a chart point, over all triangles: inverse depth is affine in
// the chart.
double drawn_height(const Drawn& tile, double exaggeration, double u, double v) {
  const lod::GridLines lines = lod::grid_lines(tile.key, tile.mesh.intervals);
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t + 2 < tile.mesh.triangles.size(); t += 3) {
    glm::dvec2 p[3];
    double w[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = tile.mesh.triangles[t + k];
      const double x = lines.u[tile.mesh.vertices[n].i];
      const double y = lines.v[tile.mesh.vertices[n].j];
      p[k] = {x - u, y - v};
      w[k] = lod::inverse_depth(x, y, exaggeration * tile.height_m[n], kRadius);
    }
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    const double whole = cross(p[1] - p[0], p[2] - p[0]);
    const double share[3]{cross(p[1], p[2]) / whole, cross(p[2], p[0]) / whole, cross(p[0], p[1]) / whole};
    if (std::min({share[0], share[1], share[2]}) < -1e-9) continue;
    const double depth = share[0] * w[0] + share[1] * w[1] + share[2] * w[2];
    lowest = std::min(lowest, std::sqrt(u * u + v * v + 1.0) / depth - kRadius);
  }
  return lowest;
}

// slack: how much higher the profile could be, in post spacings.
void expect_below(const Drawn& tile, double exaggeration, int samples, std::vector<double>& slack) {
  const lod::OccluderProfile occluders =
      lod::make_occluder_profile(tile.key, tile.mesh, tile.height_m, exaggeration, kRadius);
  const lod::GridLines lines = lod::grid_lines(tile.key, lod::kOccluderPieces);
  const double spacing_m = lod::post_spacing_m(tile.key.level, tile.mesh.intervals, kRadius);
  for (std::size_t line = 0; line <= lod::kOccluderStrips; ++line) {
    for (std::size_t piece = 0; piece < lod::kOccluderPieces; ++piece) {
      double column = std::numeric_limits<double>::infinity();
      double row = column;
      for (int s = 0; s <= samples; ++s) {
        const double t = static_cast<double>(s) / samples;
        const double v = lines.v[piece] + t * (lines.v[piece + 1] - lines.v[piece]);
        const double u = lines.u[piece] + t * (lines.u[piece + 1] - lines.u[piece]);
        column = std::min(column, drawn_height(tile, exaggeration, lines.u[2 * line], v));
        row = std::min(row, drawn_height(tile, exaggeration, u, lines.v[2 * line]));
      }
      const auto wall_c = static_cast<double>(occluders.columns[line][piece]);
      const auto wall_r = static_cast<double>(occluders.rows[line][piece]);
      ASSERT_TRUE(std::isfinite(column) && std::isfinite(row));
      // The samples are that exact.
      ASSERT_LE(wall_c, column + 1e-6) << lod::to_string(tile.key) << " column " << line << " piece " << piece;
      ASSERT_LE(wall_r, row + 1e-6) << lod::to_string(tile.key) << " row " << line << " piece " << piece;
      slack.push_back((column - wall_c) / spacing_m);
      slack.push_back((row - wall_r) / spacing_m);
    }
  }
}

TEST(OccluderProfile, LiesBelowTheDrawnTrianglesAndNotFar) {
  const lod_test::Terrain terrain(7, 3000, 200000);
  test_support::Random random(71);
  std::vector<double> slack;
  for (const int level : {0, 3, 6, 9, 12}) {
    const std::int32_t last = (1 << level) - 1;
    const lod::TileKey key{static_cast<mars::Face>(random.integer(0, 5)), level, random.integer(0, last),
                           random.integer(0, last)};
    const double spacing = lod::post_spacing_m(level, 16, kRadius);
    expect_below(meshed(terrain.posts(key, 16), 0.02 * spacing), random.log_uniform(0.1, 5), 32, slack);
  }
  std::sort(slack.begin(), slack.end());
  EXPECT_LT(slack[slack.size() / 2], 1e-3);  // kinks that lie between the samples
}

// Few triangles, so that one piece is under a long flat edge: the profile must include the sagitta.
TEST(OccluderProfile, IncludesTheSagittaOfWideTriangles) {
  const lod::TileKey key{mars::Face::kPlusY, 1, 1, 0};
  const lod::Posts posts = lod_test::make_posts(key, 8, [](int, int) { return 100.0; });
  lod::TileMesh mesh;
  mesh.intervals = 8;
  mesh.vertices = {{0, 0}, {8, 0}, {0, 8}, {8, 8}};
  mesh.triangles = {0, 1, 3, 0, 3, 2};
  const Drawn tile{key, mesh, std::vector<double>(4, 100.0)};
  std::vector<double> slack;
  expect_below(tile, 1.0, 64, slack);
  EXPECT_LT(*std::max_element(slack.begin(), slack.end()), 1e-4);
  const lod::OccluderProfile occluders = lod::make_occluder_profile(key, mesh, tile.height_m, 1.0, kRadius);
  EXPECT_LT(occluders.columns[0][3], -1e5F);
}

TEST(OccluderProfile, TheFullGridGivesTheLowestPostsOfALine) {
  const lod::TileKey key{mars::Face::kMinusX, 9, 100, 371};
  const lod_test::Terrain terrain(3, 500, 5000);
  const lod::Posts posts = terrain.posts(key, 32);
  const lod::TileMesh mesh = lod::mesh_full(32);
  const lod::OccluderProfile occluders =
      lod::make_occluder_profile(key, mesh, lod::vertex_heights(mesh, posts), 2.0, kRadius, 0.25);
  for (int line = 0; line <= lod::kOccluderStrips; ++line) {
    for (int piece = 0; piece < lod::kOccluderPieces; ++piece) {
      double column = posts.at(8 * line, 4 * piece);
      double row = posts.at(4 * piece, 8 * line);
      for (int n = 1; n <= 4; ++n) {
        column = std::min(column, posts.at(8 * line, 4 * piece + n));
        row = std::min(row, posts.at(4 * piece + n, 8 * line));
      }
      const auto l = static_cast<std::size_t>(line);
      const auto p = static_cast<std::size_t>(piece);
      ASSERT_LE(occluders.columns[l][p], 2.0 * column - 0.25);
      ASSERT_LE(occluders.rows[l][p], 2.0 * row - 0.25);
      // Sag of 320 m chords: 4 mm.
      ASSERT_GE(occluders.columns[l][p], 2.0 * column - 0.26);
      ASSERT_GE(occluders.rows[l][p], 2.0 * row - 0.26);
    }
  }
}

TEST(OccluderProfile, RefusesMeshesThatDoNotFit) {
  const lod::TileKey key{mars::Face::kPlusX, 2, 1, 1};
  const lod::TileMesh mesh = lod::mesh_full(8);
  const std::vector<double> heights(81, 0.0);
  EXPECT_THROW(lod::make_occluder_profile(key, lod::mesh_full(4), std::vector<double>(25, 0.0), 1, kRadius),
               std::invalid_argument);
  EXPECT_THROW(lod::make_occluder_profile(key, mesh, std::span(heights).first(80), 1, kRadius),
               std::invalid_argument);
  EXPECT_THROW(lod::make_occluder_profile(key, mesh, std::vector<double>(81, -1e5), 100, kRadius),
               std::invalid_argument);
}

}  // namespace
