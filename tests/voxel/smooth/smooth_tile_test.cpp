// Tests smooth tiles: posts, borders between levels and faces, bounds.
#include "vpe/voxel/smooth/smooth_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "relief/field/patch.h"
#include "tests/voxel/smooth/smooth_fixture.h"
#include "vpe/voxel/smooth/smooth_ray.h"

namespace {

namespace core = vpe::core;
using test_support::kPatches;
using test_support::name_of;
using test_support::Random;
using vpe::voxel::PatchPoint;
using vpe::voxel::SmoothTile;

int cell_of(const std::vector<double>& lines, double x) {
  return static_cast<int>(std::upper_bound(lines.begin() + 1, lines.end() - 1, x) - lines.begin()) - 1;
}

// The ground of one tile in a direction that lies in it or on its border.
PatchPoint point_in(const SmoothTile& tile, const glm::dvec3& direction) {
  const mars::ChartPoint at = mars::chart_on(tile.key().face, direction);
  const int i = cell_of(tile.u_lines(), at.u);
  const int j = cell_of(tile.v_lines(), at.v);
  return patch_point(tile, tile.patch(i, j, 1), 1, 3.4e6 * direction, i, j);
}

class SmoothTiles : public testing::Test {
 protected:
  SmoothTiles() : planet_(test_support::levels_planet(dir_ / "levels.vpe")) {}

  std::vector<lod::TileTree::Index> finest() const {
    std::vector<lod::TileTree::Index> found;
    for (lod::TileTree::Index n = 0; n < planet_.tree().size(); ++n)
      if (!planet_.tree()[n].has_children) found.push_back(n);
    return found;
  }
  // The finest tile about a direction.
  lod::TileTree::Index at(const glm::dvec3& direction) const {
    const mars::ChartPoint point = mars::chart_point(direction);
    auto index = static_cast<lod::TileTree::Index>(point.face);
    while (planet_.tree()[index].has_children) {
      const lod::TileKey finer = lod::tile_at(point, planet_.tree()[index].key.level + 1);
      index = planet_.tree().first_child(index) +
              static_cast<lod::TileTree::Index>((finer.i & 1) + 2 * (finer.j & 1));
    }
    return index;
  }

  test_support::TempDir dir_;
  test_support::SmoothPlanet planet_;
};

TEST_F(SmoothTiles, PatchesGoThroughTheirPosts) {
  for (const core::RayPatch patch : kPatches) {
    for (const lod::TileTree::Index n : finest()) {
      const auto tile = planet_.ground.tile(n, patch);
      const auto posts = planet_.surface.tile(tile->key());
      for (int j = 1; j + 1 < tile->intervals(); j += 5) {
        for (int i = 1; i + 1 < tile->intervals(); i += 3) {
          const double height_m = posts->data.posts.at(i, j);
          const auto h = [&](int ci, int cj, double u, double v) {
            return 2.5 * tile->base_m() + tile->patch(ci, cj, 2.5).at(u, v).h;
          };
          ASSERT_NEAR(h(i, j, 0, 0), 2.5 * height_m, 2e-3);
          ASSERT_NEAR(h(i - 1, j, 1, 0), 2.5 * height_m, 2e-3);
          ASSERT_NEAR(h(i - 1, j - 1, 1, 1), 2.5 * height_m, 2e-3);
        }
      }
    }
  }
}

// Both sides of every border end in the same curve: between equal and unequal levels, over edges of the cube, at corners.
TEST_F(SmoothTiles, NeighboursMeetWithoutAStep) {
  Random random(21);
  for (const core::RayPatch patch : kPatches) {
    double worst_m = 0;
    int unequal = 0;
    int over_edges = 0;
    for (const lod::TileTree::Index n : finest()) {
      const auto tile = planet_.ground.tile(n, patch);
      const mars::ChartRect rect = lod::chart_rect(tile->key());
      for (int k = 0; k < 160; ++k) {
        const int side = random.integer(0, 3);
        // Anywhere along the side, or beside one of its ends.
        double t = random.uniform(0, 1);
        if (k % 4 == 0)
          t = random.integer(0, 1) == 0 ? random.log_uniform(1e-6, 0.03) : 1 - random.log_uniform(1e-6, 0.03);
        if (k % 16 == 0) t = random.integer(0, 1);
        const double u = side == 0 ? rect.u0 : (side == 1 ? rect.u1 : rect.u0 + t * (rect.u1 - rect.u0));
        const double v = side == 2 ? rect.v0 : (side == 3 ? rect.v1 : rect.v0 + t * (rect.v1 - rect.v0));
        constexpr double kBeside = 1e-9;
        const glm::dvec3 direction = mars::chart_direction(rect.face, u, v);
        const glm::dvec3 beyond =
            mars::chart_direction(rect.face, u + (side == 0 ? -kBeside : (side == 1 ? kBeside : 0)),
                                  v + (side == 2 ? -kBeside : (side == 3 ? kBeside : 0)));
        const lod::TileTree::Index other = at(beyond);
        if (other == n) continue;
        const auto beside = planet_.ground.tile(other, patch);
        unequal += beside->key().level != tile->key().level ? 1 : 0;
        over_edges += beside->key().face != rect.face ? 1 : 0;
        const double step_m =
            std::abs(point_in(*tile, direction).height_m - point_in(*beside, direction).height_m);
        worst_m = std::max(worst_m, step_m);
        // Heights are floats about the middle of each tile, of some kilometres.
        ASSERT_LE(step_m, 2e-3) << name_of(patch) << " " << lod::to_string(tile->key()) << " and "
                                << lod::to_string(beside->key()) << ", side " << side << " at " << t;
      }
    }
    std::printf("%s: steps of at most %.1e m\n", name_of(patch), worst_m);
    EXPECT_GT(unequal, 1000);
    EXPECT_GT(over_edges, 1000);
  }
}

// Between equal levels the normal goes on, too.
TEST_F(SmoothTiles, BicubicNormalsGoOnAcrossBorders) {
  Random random(22);
  double worst_deg = 0;            // on one face
  double worst_over_edge_deg = 0;  // where posts alone agree
  int count = 0;
  for (const lod::TileTree::Index n : finest()) {
    const auto tile = planet_.ground.tile(n, core::RayPatch::kBicubic);
    const mars::ChartRect rect = lod::chart_rect(tile->key());
    for (int k = 0; k < 40; ++k) {
      const double t = random.uniform(0.1, 0.9);  // corners may have a kink where levels meet
      const bool north = k % 2 == 0;
      const double u = north ? rect.u1 : rect.u0 + t * (rect.u1 - rect.u0);
      const double v = north ? rect.v0 + t * (rect.v1 - rect.v0) : rect.v1;
      const glm::dvec3 direction = mars::chart_direction(rect.face, u, v);
      const lod::TileTree::Index other =
          at(mars::chart_direction(rect.face, u + (north ? 1e-9 : 0), v + (north ? 0 : 1e-9)));
      if (other == n) continue;
      const auto beside = planet_.ground.tile(other, core::RayPatch::kBicubic);
      if (beside->key().level != tile->key().level) continue;
      ++count;
      const double sine =
          glm::length(glm::cross(point_in(*tile, direction).normal, point_in(*beside, direction).normal));
      const double kink_deg = 57.29577951 * std::asin(sine);
      double& worst = beside->key().face == rect.face ? worst_deg : worst_over_edge_deg;
      worst = std::max(worst, kink_deg);
    }
  }
  std::printf("%d places, worst kink %.1e degrees, over edges of the cube %.2f\n", count, worst_deg,
              worst_over_edge_deg);
  EXPECT_GT(count, 1000);
  EXPECT_LT(worst_deg, 1e-2);
  EXPECT_LT(worst_over_edge_deg, 0.5);
}

TEST_F(SmoothTiles, BoundsHoldThePatches) {
  Random random(23);
  for (const core::RayPatch patch : kPatches) {
    for (const lod::TileTree::Index n : finest()) {
      const auto tile = planet_.ground.tile(n, patch);
      const double exaggeration = random.log_uniform(0.2, 3);
      const auto ball = planet_.ground.ball(n, exaggeration);
      for (int k = 0; k < 60; ++k) {
        const int i = random.integer(0, tile->intervals() - 1);
        const int j = random.integer(0, tile->intervals() - 1);
        const double u = random.uniform(0, 1);
        const double v = random.uniform(0, 1);
        const double height_m = tile->base_m() + tile->patch(i, j, 1).at(u, v).h;
        for (int b = 1; b <= tile->levels(); ++b) {
          const SmoothTile::Bounds& bounds = tile->bounds(b, i >> b, j >> b);
          ASSERT_LE(static_cast<double>(bounds.low_m), height_m + 1e-6);
          ASSERT_GE(static_cast<double>(bounds.high_m), height_m - 1e-6);
        }
        ASSERT_LE(exaggeration * height_m, ball.highest_m + 1e-6);
        const auto at = [](int line) { return static_cast<std::size_t>(line); };
        const double chart_u =
            tile->u_lines()[at(i)] + u * (tile->u_lines()[at(i) + 1] - tile->u_lines()[at(i)]);
        const double chart_v =
            tile->v_lines()[at(j)] + v * (tile->v_lines()[at(j) + 1] - tile->v_lines()[at(j)]);
        const glm::dvec3 point = (planet_.ground.radius_m() + exaggeration * height_m) *
                                 mars::chart_direction(tile->key().face, chart_u, chart_v);
        ASSERT_LE(glm::length(point - ball.centre_m), ball.radius_m * (1 + 1e-12) + 1e-3);
      }
    }
  }
}

// The patches are relief's Catmull-Rom patches where posts are even, and have their bound against facets.
TEST_F(SmoothTiles, InnerPatchesAreThoseOfEvenPosts) {
  for (const lod::TileTree::Index n : finest()) {
    const auto tile = planet_.ground.tile(n, core::RayPatch::kBicubic);
    if (tile->key().level < 5) continue;  // posts are even between knots
    const auto posts = planet_.surface.tile(tile->key());
    for (int j = 2; j + 3 < tile->intervals(); j += 4) {
      for (int i = 2; i + 3 < tile->intervals(); i += 3) {
        std::array<double, 16> around{};
        for (int k = 0; k < 16; ++k)
          around[static_cast<std::size_t>(k)] = posts->data.posts.at(i - 1 + k % 4, j - 1 + k / 4);
        const relief::Patch expected = relief::Patch::bicubic(around);
        const vpe::voxel::SmoothPatch patch = tile->patch(i, j, 1);
        for (const double u : {0.1, 0.5, 0.8}) {
          const auto found = patch.at(u, 0.3);
          ASSERT_NEAR(tile->base_m() + found.h, expected.height_m(u, 0.3), 2e-3);
          ASSERT_NEAR(found.hu, expected.gradient(u, 0.3).x, 5e-3);
          ASSERT_NEAR(found.hv, expected.gradient(u, 0.3).y, 5e-3);
        }
        ASSERT_GE(tile->facet_deviation_m(), expected.facet_deviation_m() - 2e-3);
      }
    }
  }
}

TEST_F(SmoothTiles, TheReferenceSurfaceIsWithinTheStatedDeviation) {
  Random random(24);
  double largest_share = 0;
  for (const core::RayPatch patch : kPatches) {
    for (int k = 0; k < 20000; ++k) {
      const double exaggeration = k % 2 == 0 ? 1.0 : random.log_uniform(0.2, 3);
      // Half of them about the fine places.
      glm::dvec3 direction = random.direction();
      if (k % 4 >= 2) direction = glm::normalize(glm::normalize(glm::dvec3(1, 1, 1)) + 0.1 * direction);
      const auto point = planet_.ground.at(direction, {patch, exaggeration});
      const double off_m = std::abs(point.height_m - planet_.surface.at(direction, exaggeration).height_m);
      ASSERT_LE(off_m, point.deviation_m) << name_of(patch) << " times " << exaggeration;
      largest_share = std::max(largest_share, off_m / point.deviation_m);
    }
  }
  std::printf("at most %.2f of the stated deviation\n", largest_share);
  EXPECT_GT(largest_share, 0.3);  // the bound is not idle
}

}  // namespace
