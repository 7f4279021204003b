#include "paging/plan/build_plan.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <set>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

constexpr double kRadius = 3396190;

double everywhere(const lod::TileKey&, const mars::Cap&) { return 3700; }

// Wants 40 m around one direction, 3700 m elsewhere.
paging::WantedSpacing inset(const glm::dvec3& centre, double reach_rad) {
  return [=](const lod::TileKey&, const mars::Cap& cap) {
    return mars::angle_between_rad(cap.centre, centre) < cap.radius_rad + reach_rad ? 40.0 : 3700.0;
  };
}

TEST(BuildPlan, UniformPlanetHasOneLevel) {
  const paging::BuildPlan plan({7}, kRadius, everywhere);
  EXPECT_EQ(plan.leaves().size(), 6U * 256U);
  EXPECT_EQ(plan.inner().size(), 6U * 85U);
  for (const lod::TileKey& key : plan.leaves()) {
    ASSERT_EQ(key.level, 4);
    for (const lod::Edge edge : lod::kEdges) ASSERT_EQ(plan.edge_step(key, edge), 0);
  }
}

TEST(BuildPlan, InsetsAreReachedByStepsOfTwo) {
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1, 1, 1));
  for (const glm::dvec3& centre : {glm::dvec3(1, 0, 0), corner, glm::normalize(glm::dvec3(1, 0.3, -0.99))}) {
    const paging::BuildPlan plan({7}, kRadius, inset(centre, 0.002));
    int finest = 0;
    double area = 0;
    for (const lod::TileKey& key : plan.leaves()) {
      finest = std::max(finest, key.level);
      area += std::pow(0.25, key.level);
      ASSERT_TRUE(plan.is_leaf(key));
      for (const lod::Edge edge : lod::kEdges) {
        const lod::TileKey across = lod::neighbour(key, edge).key;
        const bool finer = plan.is_inner(across);
        const bool equal = plan.is_leaf(across);
        const bool coarser = key.level > 0 && plan.is_leaf(lod::parent(across));
        ASSERT_EQ(finer + equal + coarser, 1) << lod::to_string(key);
        ASSERT_EQ(plan.edge_step(key, edge), coarser ? 1 : 0);
        if (!finer) continue;
        // What lies across is at most one level finer along the shared edge.
        const lod::Edge shared = lod::neighbour(key, edge).edge;
        for (int c = 0; c < 4; ++c) {
          const lod::TileKey child = lod::child(across, c);
          const bool touches = lod::contains(key, lod::neighbour(child, shared).key);
          if (touches) {
            ASSERT_TRUE(plan.is_leaf(child)) << lod::to_string(key);
          }
        }
      }
    }
    EXPECT_EQ(finest, 11);
    EXPECT_NEAR(area, 6.0, 1e-9);  // leaves tile the six faces
  }
}

TEST(BuildPlan, CornersKnowTheCoarsestTileAround) {
  const paging::BuildPlan plan({7}, kRadius, inset({1, 0, 0}, 0.002));
  for (const lod::TileKey& key : plan.leaves()) {
    if (key.level < 7) continue;
    for (int corner = 0; corner < 4; ++corner) {
      const bool east = (corner & 1) != 0;
      const bool north = (corner & 2) != 0;
      const int level = plan.coarsest_level_at_corner(key, east, north);
      ASSERT_LE(level, key.level);
      ASSERT_GE(level, key.level - 2);
      // Never finer than the coarser of the two edges at the corner.
      const int step = std::max(plan.edge_step(key, east ? lod::Edge::kEast : lod::Edge::kWest),
                                plan.edge_step(key, north ? lod::Edge::kNorth : lod::Edge::kSouth));
      ASSERT_LE(level, key.level - step);
    }
  }
}

TEST(BuildPlan, OrdersAreStable) {
  const paging::BuildPlan plan({7}, kRadius, inset({0, 0, 1}, 0.01));
  EXPECT_TRUE(std::is_sorted(plan.leaves().begin(), plan.leaves().end(), paging::morton_less));
  std::set<lod::TileKey> done(plan.leaves().begin(), plan.leaves().end());
  for (const lod::TileKey& key : plan.inner()) {
    for (int c = 0; c < 4; ++c) ASSERT_TRUE(done.contains(lod::child(key, c)));
    done.insert(key);
  }
}

TEST(BuildPlan, RefusesTreesBeyondTheLimit) {
  const auto finer_than_sense = [](const lod::TileKey&, const mars::Cap&) { return 0.5; };
  paging::PlanLimits limits;
  limits.max_leaves = 10000;
  try {
    const paging::BuildPlan plan({7}, kRadius, finer_than_sense, limits);
    FAIL() << "no error";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("--spacing"), std::string::npos) << e.what();
  }
}

}  // namespace
