// Rays against models of sticks: watertightness, sides of voxels, Beer and Lambert, cavities, faults.
#include "objects/sticks/stick_model.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/objects/sticks/stick_shapes.h"

namespace objects {
namespace {

using stick_shapes::any_axis;
using stick_shapes::any_direction;
using stick_shapes::box_distance;
using stick_shapes::kFar;
using stick_shapes::kShapeGrid;
using stick_shapes::sphere_distance;

// Fills a block of voxels of a grid that is larger, so that its sides are not those of the grid.
VoxelGrid block(const StickGrid& grid, const glm::ivec3& from, const glm::ivec3& to) {
  VoxelGrid voxels(grid);
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      for (int z = from.z; z < to.z; ++z) voxels.set(x, y, z);
    }
  }
  return voxels;
}

TEST(StickModel, NoRaySlipsBetweenColumns) {
  const StickGrid grid{40, 40, 40, 0.1F, {-0.3F, 7.1F, 0.7F}};
  const StickModel model = build_sticks(block(grid, {5, 6, 7}, {33, 30, 29}));
  std::mt19937 random(11);
  StickHits hits;
  for (int n = 0; n < 20000; ++n) {
    // A place on an edge or a corner between columns, inside of the block.
    const glm::dvec3 inside(6 + random() % 26, 7 + random() % 22,
                            8.0 + 0.5 * static_cast<double>(random() % 40));
    const glm::vec3 at = grid.corner_m + grid.voxel_m * glm::vec3(inside);
    glm::vec3 d(any_direction(random));
    if (n % 3 == 1) d = glm::vec3(any_axis(random));
    if (n % 3 == 2) d[static_cast<int>(random() % 3)] = 0;
    if (n % 12 == 2) d = {static_cast<float>(random() % 2) - 0.5F, static_cast<float>(random() % 2) - 0.5F, 0};
    if (glm::length(d) < 0.1F) continue;
    const ModelRay ray{at - d * (6.0F / glm::length(d)), d};
    model.cast(ray, 0, kFar, hits);
    ASSERT_TRUE(hits.has_front) << n;
    // Before the block there is nothing, and the ray ends no deeper than a rounding.
    const glm::dvec3 hit = (glm::dvec3(ray.origin_m) + static_cast<double>(hits.front.t) * glm::dvec3(d) -
                            glm::dvec3(grid.corner_m)) /
                           static_cast<double>(grid.voxel_m);
    const glm::dvec3 depth = glm::min(hit - glm::dvec3(5, 6, 7), glm::dvec3(33, 30, 29) - hit);
    EXPECT_NEAR(std::min({depth.x, depth.y, depth.z}), 0, 1e-3) << n;
  }
}

TEST(StickModel, VoxelsThatShareAnEdgeHoldARayThroughIt) {
  VoxelGrid voxels({2, 2, 1, 1, {0, 0, 0}});
  voxels.set(1, 0, 0);
  voxels.set(0, 1, 0);
  StickHits hits;
  build_sticks(voxels).cast({{-1, -1, 0.5F}, {1, 1, 0}}, 0, kFar, hits);
  ASSERT_TRUE(hits.has_front);
  EXPECT_FLOAT_EQ(hits.front.t, 2);
}

TEST(StickModel, RaysInPlanesOfSidesAreInOneVoxel) {
  const StickModel model = build_sticks(block({8, 8, 8, 1, {0, 0, 0}}, {2, 2, 2}, {6, 6, 6}));
  StickHits hits;
  const auto meets = [&](const glm::vec3& from, const glm::vec3& d) {
    model.cast({from, d}, 0, kFar, hits);
    return hits.has_front;
  };
  for (const float inside : {2.0F, 3.0F, 4.0F, 5.0F}) {
    EXPECT_TRUE(meets({inside, -3, 3.5F}, {0, 1, 0}));
    EXPECT_FLOAT_EQ(hits.front.t, 5);
    EXPECT_TRUE(meets({inside, inside, 20}, {0, 0, -1}));
    EXPECT_FLOAT_EQ(hits.front.t, 14);
    EXPECT_TRUE(meets({-3, 3.5F, inside}, {1, 0, 0}));
    EXPECT_TRUE(meets({20, inside, inside}, {-1, 0, 0}));
    EXPECT_EQ(hits.front.face, glm::vec3(1, 0, 0));
  }
  EXPECT_FALSE(meets({6, -3, 3.5F}, {0, 1, 0}));  // the side belongs to the voxel on its right
  EXPECT_FALSE(meets({-3, 3.5F, 6}, {1, 0, 0}));
}

TEST(StickModel, RaysThatLeaveASideDoNotMeetIt) {
  const StickModel model = build_sticks(block({8, 8, 8, 1, {0, 0, 0}}, {2, 2, 2}, {6, 6, 6}));
  StickHits hits;
  for (int k = 0; k < 3; ++k) {
    for (const float sign : {-1.0F, 1.0F}) {
      glm::vec3 from(3.3F, 4.2F, 2.9F);
      glm::vec3 d(0.2F, 0.1F, 0.3F);
      from[k] = sign < 0 ? 2.0F : 6.0F;
      d[k] = sign;
      model.cast({from, d}, 0, kFar, hits);
      EXPECT_FALSE(hits.has_front) << k << sign;
      d[k] = -sign;
      model.cast({from, d}, 0, kFar, hits);
      ASSERT_TRUE(hits.has_front) << k << sign;
      EXPECT_EQ(hits.front.t, 0);
      EXPECT_EQ(hits.front.face[k], sign);
    }
  }
  model.cast({{3.3F, 4.2F, 2.9F}, {0.1F, -0.9F, 0.3F}}, 0, kFar, hits);
  ASSERT_TRUE(hits.has_front);  // begins inside
  EXPECT_EQ(hits.front.t, 0);
  EXPECT_EQ(hits.front.face, glm::vec3(0, 1, 0));
}

TEST(StickModel, ASlabTakesLightByBeerAndLambert) {
  const double alpha = 30.0 / 255.0;
  VoxelGrid voxels({32, 32, 32, 0.25F, {-4, -4, -4}});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      for (int z = 10; z < 20; ++z) voxels.set(x, y, z, stick_voxel({90, 120, 140, 30}, {0, 0, 1}));
    }
  }
  const StickModel model = build_sticks(voxels);
  EXPECT_EQ(model.levels()[0].voxels.size(), 1U);
  std::mt19937 random(13);
  StickHits hits;
  for (int n = 0; n < 1000; ++n) {
    glm::dvec3 d = n == 0 ? glm::dvec3(0, 0, 1) : any_direction(random);
    if (std::abs(d.z) < 0.5) continue;
    d *= 1.7;
    const glm::dvec3 middle(0, 0, -4 + 15 * 0.25);
    model.cast({glm::vec3(middle - 20.0 * d), glm::vec3(d)}, 0, kFar, hits);
    ASSERT_EQ(hits.layers.size(), 1U);  // voxels of one colour are one stretch
    EXPECT_FALSE(hits.has_front);
    const double length_m = 2.5 / std::abs(glm::normalize(d).z);
    EXPECT_NEAR(static_cast<double>(hits.layers[0].opacity), 1 - std::pow(1 - alpha, length_m / 0.25), 1e-3);
  }
  model.cast({{0.1F, 0.1F, 5}, {0, 0, -1}}, 0, 5.0F, hits);  // ends in the slab, whose top is at z = 1
  ASSERT_EQ(hits.layers.size(), 1U);
  EXPECT_FLOAT_EQ(hits.layers[0].t, 4);
  EXPECT_FLOAT_EQ(hits.layers[0].end_t, 5);
}

TEST(StickModel, RaysPassThroughAHole) {
  VoxelGrid voxels = block({24, 24, 24, 1, {0, 0, 0}}, {2, 2, 2}, {22, 22, 22});
  for (int y = 2; y < 22; ++y) {
    for (int x = 9; x < 15; ++x) {
      for (int z = 10; z < 14; ++z) voxels.clear(x, y, z);
    }
  }
  const StickModel model = build_sticks(voxels);
  StickHits hits;
  model.cast({{12, -10, 12}, {0.01F, 1, 0.02F}}, 0, kFar, hits);
  EXPECT_FALSE(hits.has_front);
  model.cast({{5, -10, 12}, {0, 1, 0}}, 0, kFar, hits);
  ASSERT_TRUE(hits.has_front);
  EXPECT_FLOAT_EQ(hits.front.t, 12);
  model.cast({{12, 4, 12}, {0, 0, -1}}, 0, kFar, hits);  // from the cavity onto its floor
  ASSERT_TRUE(hits.has_front);
  EXPECT_FLOAT_EQ(hits.front.t, 2);
  EXPECT_EQ(hits.front.face, glm::vec3(0, 0, 1));
  model.cast({{12, -10, 13}, {0, 1, 0.1F}}, 0, kFar, hits);  // climbs to the ceiling
  ASSERT_TRUE(hits.has_front);
  EXPECT_EQ(hits.front.face, glm::vec3(0, -1, 0));
  model.cast({{12, 4, 12}, {0, 1, 0.25F}}, 0, kFar, hits);
  ASSERT_TRUE(hits.has_front);
  EXPECT_FLOAT_EQ(hits.front.t, 8);
  EXPECT_EQ(hits.front.face, glm::vec3(0, 0, -1));
}

TEST(StickModel, OddRaysMeetNothing) {
  const StickModel model = build_sticks(block({8, 8, 8, 1, {0, 0, 0}}, {2, 2, 2}, {6, 6, 6}));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  StickHits hits;
  const auto meets = [&](const ModelRay& ray, std::size_t level, float until) {
    model.cast(ray, level, until, hits);
    return hits.has_front;
  };
  EXPECT_FALSE(meets({{4, 4, 4}, {0, 0, 0}}, 0, kFar));
  EXPECT_FALSE(meets({{4, kNan, 4}, {0, 0, 1}}, 0, kFar));
  EXPECT_FALSE(meets({{4, 4, 4}, {kFar, 0, 1}}, 0, kFar));
  EXPECT_FALSE(meets({{4, 4, 20}, {0, 0, -1}}, 0, 14.0F));  // until itself does not count
  EXPECT_TRUE(meets({{4, 4, 20}, {0, 0, -1}}, 0, 14.001F));
  EXPECT_FALSE(meets({{4, 4, 20}, {0, 0, -1}}, 0, 0.0F));
  EXPECT_FALSE(meets({{4, 4, 20}, {0, 0, -1}}, 0, kNan));
  EXPECT_FALSE(meets({{4, 4, 20}, {0, 0, -1}}, 9, kFar));
  EXPECT_TRUE(meets({{4, 4, 20}, {1e-38F, -1e-38F, -1e-30F}}, 0, kFar));
  EXPECT_FALSE(StickModel().ball().radius_m > 0);
}

TEST(StickModel, TheBallHoldsAllVoxels) {
  const StickModel model = build_sticks(stick_shapes::fill(kShapeGrid, sphere_distance));
  EXPECT_LT(model.ball().radius_m, 1.3F * 1.8F);  // the coarsest level has voxels of 0.8 m
  std::mt19937 random(17);
  StickHits hits;
  for (int n = 0; n < 2000; ++n) {
    const glm::vec3 d(any_direction(random));
    for (std::size_t level = 0; level < model.levels().size(); ++level) {
      model.cast({d * -20.0F, d}, level, kFar, hits);
      if (!hits.has_front) continue;
      EXPECT_LE(glm::distance(d * (hits.front.t - 20.0F), model.ball().centre_m),
                model.ball().radius_m * 1.00001F);
    }
  }
}

TEST(StickModel, CheckFindsFaults) {
  const StickModel good = build_sticks(stick_shapes::fill(kShapeGrid, box_distance));
  const StickModel::Level level = good.levels()[0];
  EXPECT_EQ(check(level), "");
  const auto fault = [&](const std::function<void(StickModel::Level&)>& spoil) {
    StickModel::Level bad = level;
    spoil(bad);
    EXPECT_THROW(StickModel({bad}), std::invalid_argument);
    return check(bad);
  };
  EXPECT_NE(fault([](auto& l) { l.grid.columns_x = 0; }), "");
  EXPECT_NE(fault([](auto& l) { l.grid.height = 5000; }), "");
  EXPECT_NE(fault([](auto& l) { l.grid.voxel_m = 0; }), "");
  EXPECT_NE(fault([](auto& l) { l.grid.corner_m.y = kFar; }), "");
  EXPECT_NE(fault([](auto& l) { l.columns.pop_back(); }), "");
  EXPECT_NE(fault([](auto& l) { l.columns[100] = 1000; }), "");
  EXPECT_NE(fault([](auto& l) { l.sticks.clear(); }), "");
  EXPECT_NE(fault([](auto& l) { l.sticks[1].kind = StickKind::kEmpty; }), "");
  EXPECT_NE(fault([](auto& l) { l.sticks[1].kind = static_cast<StickKind>(7); }), "");
  EXPECT_NE(fault([](auto& l) { l.sticks[1].runs = 7; }), "");
  EXPECT_NE(fault([](auto& l) { l.runs[0].length = 0; }), "");
  EXPECT_NE(fault([](auto& l) { l.runs[0].length = 65; }), "");
  EXPECT_NE(fault([](auto& l) { l.runs[0].first_voxel = 0xFFFFFFFF; }), "");
  EXPECT_NE(fault([](auto& l) { l.runs[0].is_opaque = false; }), "");
  EXPECT_NE(fault([](auto& l) { l.voxels[0].colour.a = 0; }), "");
  EXPECT_THROW(StickModel({level, level}), std::invalid_argument);  // must grow
}

}  // namespace
}  // namespace objects
