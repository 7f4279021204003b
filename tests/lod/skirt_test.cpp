#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "lod/select.h"
#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace {

using lod::Edge;
using lod::SelectedTile;
using lod::Selection;
using lod::TileTree;
using test_support::Random;

const SelectedTile* drawn_at(const Selection& s, const glm::dvec3& direction) {
  const lod::TileKey key = lod::tile_at(mars::chart_point(direction), lod::kMaxLevel);
  for (const SelectedTile& tile : s.tiles) {
    if (lod::contains(tile.key, key)) return &tile;
  }
  return nullptr;
}

bool exact(const TileTree& tree, const SelectedTile& a, const SelectedTile& b) {
  if (a.key.level != b.key.level) return false;
  const bool inner = tree[a.index].has_children;
  if (inner != tree[b.index].has_children) return false;
  if (inner) return true;
  const bool full = lod::is_full_grid(tree[a.index], a.variant);
  return full == lod::is_full_grid(tree[b.index], b.variant) && (full || a.variant == b.variant);
}

// Returns a point just outside the tile across an edge, at `t` along it.
glm::dvec3 across(const lod::TileKey& key, Edge edge, double t) {
  const mars::ChartRect r = lod::chart_rect(key);
  const double step = 1e-9;
  const double u = r.u0 + t * (r.u1 - r.u0);
  const double v = r.v0 + t * (r.v1 - r.v0);
  switch (edge) {
    case Edge::kWest: return mars::cube_point(key.face, r.u0 - step, v);
    case Edge::kEast: return mars::cube_point(key.face, r.u1 + step, v);
    case Edge::kSouth: return mars::cube_point(key.face, u, r.v0 - step);
    case Edge::kNorth: return mars::cube_point(key.face, u, r.v1 + step);
  }
  return {};
}

// Returns a random selection: a panorama or a view down, any tolerance, with or without a limit of triangles.
Selection random_selection(Random& random, const TileTree& tree, double exaggeration) {
  vpe::core::View view;
  const glm::dvec3 place = random.integer(0, 3) == 0 ? glm::dvec3(1, 1, -1) : random.direction();
  const mars::LonLat at = mars::lon_lat(place);
  view.camera = mars::to_camera(mars::Pose{at.lon_deg, at.lat_deg, random.log_uniform(1e4, 1e7), 30, -70, 0},
                                fake::kRadius_m);
  if (random.integer(0, 1) == 0) view.projection = vpe::core::Projection::kEquirectangular;
  lod::SelectOptions options;
  options.tolerance_px = random.log_uniform(0.05, 50);
  options.exaggeration = exaggeration;
  options.max_triangles = random.integer(0, 1) == 0 ? 0 : random.integer(5000, 200000);
  lod::SelectScratch scratch;
  Selection s;
  lod::select(options, tree, lod::select_view(view), scratch, s);
  return s;
}

TEST(Skirt, CoversWhatIsDrawnAcrossEveryEdgeAndNoMore) {
  Random random(51);
  const TileTree tree = fake::tree(fake::rough(2, 8));
  std::vector<std::array<float, 4>> depths;
  int none = 0;
  int some = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double exaggeration = random.integer(0, 1) == 0 ? 1.0 : random.log_uniform(0.1, 20);
    const Selection s = random_selection(random, tree, exaggeration);
    lod::skirt_depths(s, tree, depths);
    ASSERT_EQ(depths.size(), s.tiles.size());
    for (std::size_t n = 0; n < s.tiles.size(); ++n) {
      const SelectedTile& tile = s.tiles[n];
      for (const Edge edge : lod::kEdges) {
        // The deepest tiles are 6 levels below: 64 samples meet all of them.
        double gap = 0;
        for (int k = 0; k < 64; ++k) {
          const SelectedTile* other = drawn_at(s, across(tile.key, edge, (k + 0.5) / 64));
          if (other == nullptr || exact(tree, tile, *other)) continue;
          gap = std::max(gap, tile.geometric_error_m + other->geometric_error_m);
        }
        const double depth = static_cast<double>(depths[n][static_cast<std::size_t>(edge)]);
        if (gap == 0) {
          ASSERT_EQ(depth, 0.0) << lod::to_string(tile.key);
          ++none;
        } else {
          ASSERT_GE(depth, gap) << lod::to_string(tile.key);
          const cull::BoundingRegion region = tree.region(tile.index, exaggeration, tile.geometric_error_m);
          if (gap < 0.5 * region.min_radius_m) {
            ASSERT_LE(depth, gap * region.max_radius_m / (region.min_radius_m - gap) * (1 + 1e-6));
          }
          ++some;
        }
      }
    }
  }
  EXPECT_GT(none, 500);
  EXPECT_GT(some, 500);
}

TEST(Skirt, TheFootOfAStraightEdgeReachesBelowTheGapEverywhere) {
  Random random(52);
  const TileTree tree = fake::tree(fake::rough(2, 6));
  std::vector<std::array<float, 4>> depths;
  double tightest = std::numeric_limits<double>::infinity();
  int edges = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double exaggeration = random.integer(0, 1) == 0 ? 1.0 : random.log_uniform(0.1, 20);
    const Selection s = random_selection(random, tree, exaggeration);
    lod::skirt_depths(s, tree, depths);
    for (std::size_t n = 0; n < s.tiles.size(); ++n) {
      const SelectedTile& tile = s.tiles[n];
      const cull::BoundingRegion region = tree.region(tile.index, exaggeration, 0.0);
      const double depth = static_cast<double>(depths[n][1]);
      if (depth == 0.0) continue;
      // The least that the depth was made for.
      double gap = 0;
      for (int k = 0; k < 64; ++k) {
        const SelectedTile* other = drawn_at(s, across(tile.key, Edge::kEast, (k + 0.5) / 64));
        if (other != nullptr && !exact(tree, tile, *other))
          gap = std::max(gap, tile.geometric_error_m + other->geometric_error_m);
      }
      // One straight piece of the eastern border, as long as the error allows it to sagitta.
      const double v0 = region.rect.v0;
      const double v1 = v0 + (region.rect.v1 - v0) * std::pow(0.5, random.integer(0, 5));
      const double r0 = random.uniform(region.min_radius_m, region.max_radius_m);
      const double r1 = random.uniform(region.min_radius_m, region.max_radius_m);
      const glm::dvec3 d0 = mars::chart_direction(region.rect.face, region.rect.u1, v0);
      const glm::dvec3 d1 = mars::chart_direction(region.rect.face, region.rect.u1, v1);
      for (int k = 0; k <= 16; ++k) {
        const glm::dvec3 top = d0 * r0 + (d1 * r1 - d0 * r0) * (k / 16.0);
        if (glm::length(top) < region.min_radius_m - tile.geometric_error_m) continue;  // no such mesh
        // The foot under it: on the line between the lowered ends, in the same direction.
        const glm::dvec3 normal = glm::cross(glm::normalize(top), glm::cross(d0, d1));
        const double a = glm::dot(normal, d0 * (r0 - depth));
        const double b = glm::dot(normal, d1 * (r1 - depth));
        const double t = a / (a - b);
        const glm::dvec3 foot = d0 * (r0 - depth) * (1 - t) + d1 * (r1 - depth) * t;
        ASSERT_GE(glm::length(top) - glm::length(foot), gap - 1e-6) << lod::to_string(tile.key);
        tightest = std::min(tightest, (glm::length(top) - glm::length(foot)) / gap);
        ++edges;
      }
    }
  }
  EXPECT_GT(edges, 1000);
  EXPECT_LT(tightest, 1.1);
}

TEST(Skirt, AlikeTilesNeedNone) {
  // A ball that is drawn at one level.
  const TileTree ball = fake::tree(fake::uniform(3));
  vpe::core::View view;
  view.camera = mars::to_camera(mars::Pose{10, 20, 3e7, 0, -90, 0}, fake::kRadius_m);
  lod::SelectOptions options;
  lod::SelectScratch scratch;
  Selection s;
  std::vector<std::array<float, 4>> depths;
  for (const double px : {1e9, 0.0}) {
    options.tolerance_px = px;
    lod::select(options, ball, lod::select_view(view), scratch, s);
    ASSERT_FALSE(s.tiles.empty());
    lod::skirt_depths(s, ball, depths);
    for (const auto& tile : depths) EXPECT_EQ(tile, (std::array<float, 4>{}));
  }
}

}  // namespace
