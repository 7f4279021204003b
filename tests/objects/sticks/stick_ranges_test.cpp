// Ranges to models of sticks: closed forms, and a march from voxel to voxel.
#include <gtest/gtest.h>

#include <algorithm>

#include "objects/sticks/stick_model.h"
#include "tests/objects/sticks/stick_shapes.h"

namespace objects {
namespace {

using namespace stick_shapes;

// Voxels of a convex shape by their centres hold all places deeper than half their diagonal, and none that is
// farther.
void expect_ranges(double (*distance)(const glm::dvec3&), unsigned seed) {
  const StickModel model = build_sticks(stick_shapes::fill(kShapeGrid, distance));
  const double half_diagonal_m = 0.5 * std::sqrt(3.0) * static_cast<double>(kShapeEdge_m);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1.4, 1.4);
  StickHits hits;
  int met = 0;
  for (int n = 0; n < 4000; ++n) {
    const glm::dvec3 d = n % 3 == 0 ? any_axis(random) : any_direction(random);
    const glm::dvec3 near(any(random), any(random), any(random));
    const ModelRay ray{glm::vec3(near - 5.0 * d), glm::vec3(d)};
    model.cast(ray, 0, kFar, hits);
    EXPECT_TRUE(hits.layers.empty());
    const double end = hits.has_front ? static_cast<double>(hits.front.t) : 12.0;
    for (int k = 0; k < 300; ++k) {
      const glm::dvec3 at = glm::dvec3(ray.origin_m) + glm::dvec3(ray.direction) * (end * k / 300.0);
      ASSERT_GT(distance(at), -half_diagonal_m - 1e-5)
          << "ray " << n << " passes through at " << end * k / 300.0;
    }
    if (!hits.has_front) continue;
    ++met;
    const glm::dvec3 at = glm::dvec3(ray.origin_m) + glm::dvec3(ray.direction) * end;
    EXPECT_LT(distance(at), half_diagonal_m + 1e-5) << n;
    EXPECT_LT(glm::dot(glm::dvec3(hits.front.face), d), 1e-9) << n;
  }
  EXPECT_GT(met, 1000);
}

TEST(StickRanges, RangesOfASphereAreWithinAVoxel) { expect_ranges(sphere_distance, 1); }
TEST(StickRanges, RangesOfABoxAreWithinAVoxel) { expect_ranges(box_distance, 2); }
TEST(StickRanges, RangesOfACylinderAreWithinAVoxel) { expect_ranges(cylinder_distance, 3); }
TEST(StickRanges, RangesOfAConeAreWithinAVoxel) { expect_ranges(cone_distance, 4); }

TEST(StickRanges, RangesTowardsTheMiddleOfASphereFollowTheClosedForm) {
  const StickModel model = build_sticks(stick_shapes::fill(kShapeGrid, sphere_distance));
  std::mt19937 random(5);
  StickHits hits;
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 d = n % 4 == 0 ? any_axis(random) : any_direction(random);
    model.cast({glm::vec3(-4.0 * d), glm::vec3(2.0 * d)}, 0, kFar, hits);
    ASSERT_TRUE(hits.has_front);
    EXPECT_NEAR(2.0 * static_cast<double>(hits.front.t), 4.0 - 1.3, static_cast<double>(kShapeEdge_m)) << n;
  }
}

// What a march from side to side of voxels finds, cell by cell at the middles of its steps.
struct Marched {
  glm::ivec3 voxel{-1, -1, -1};
  double t = -1;
  double depth = 0;  // optical depth of semi-transparent voxels before it
};
Marched march(const VoxelGrid& voxels, const std::vector<std::uint8_t>& alphas, const ModelRay& ray,
              double until) {
  const StickGrid& g = voxels.grid();
  const glm::dvec3 p = (glm::dvec3(ray.origin_m) - glm::dvec3(g.corner_m)) / static_cast<double>(g.voxel_m);
  const glm::dvec3 q = glm::dvec3(ray.direction) / static_cast<double>(g.voxel_m);
  std::vector<double> sides{0.0, until};
  const glm::ivec3 size(g.columns_x, g.columns_y, g.height);
  for (int k = 0; k < 3; ++k) {
    for (int n = 0; q[k] != 0 && n <= size[k]; ++n) {
      if (const double t = (n - p[k]) / q[k]; t > 0 && t < until) sides.push_back(t);
    }
  }
  std::sort(sides.begin(), sides.end());
  Marched out;
  for (std::size_t n = 0; n + 1 < sides.size(); ++n) {
    if (sides[n + 1] - sides[n] < 1e-13) continue;
    const glm::ivec3 at(glm::floor(p + q * (0.5 * (sides[n] + sides[n + 1]))));
    if (!voxels.is_set(at.x, at.y, at.z)) continue;
    const std::uint8_t alpha = alphas[voxels.place(at.x, at.y, at.z)];
    if (alpha == 255) {
      out.voxel = at;
      out.t = sides[n];
      return out;
    }
    out.depth -= std::log(1.0 - alpha / 255.0) * (sides[n + 1] - sides[n]) * glm::length(q);
  }
  return out;
}

TEST(StickRanges, AgreesWithAMarchThroughVoxels) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  StickHits hits;
  int met = 0;
  int layered = 0;
  for (int model_number = 0; model_number < 12; ++model_number) {
    const StickGrid grid{7 + 5 * (model_number % 5),
                         33 - 6 * (model_number % 4),
                         5 + 9 * (model_number % 8),
                         0.37F,
                         {1.5F, -20.25F, 3.0F}};
    VoxelGrid voxels(grid);
    std::vector<std::uint8_t> alphas(voxels.columns() * static_cast<std::size_t>(grid.height), 0);
    const double share = 0.004 * (1 + model_number % 4) * (1 + model_number % 3);
    for (std::size_t n = 0; n < alphas.size(); ++n) {
      if (any(random) > share) continue;
      const glm::ivec3 at = voxels.voxel_of(n);
      const bool is_clear = model_number % 2 == 1 && any(random) < 0.6;
      alphas[n] = static_cast<std::uint8_t>(is_clear ? 60 + 60 * (random() % 2) : 255U);
      const Rgba colour{static_cast<std::uint8_t>(random() % 256), 1, 2, alphas[n]};
      voxels.set(at.x, at.y, at.z, stick_voxel(colour, {0, 0, 1}));
    }
    const StickModel model = build_sticks(voxels);
    const glm::dvec3 size_m = 0.37 * glm::dvec3(grid.columns_x, grid.columns_y, grid.height);
    for (int n = 0; n < 2500; ++n) {
      const glm::dvec3 d = n % 4 == 0 ? any_axis(random) : any_direction(random);
      const glm::dvec3 near =
          glm::dvec3(grid.corner_m) + size_m * glm::dvec3(any(random), any(random), any(random));
      const ModelRay ray{glm::vec3(near - d * (n % 5 == 0 ? 0.0 : 30.0)), glm::vec3(0.7 * d)};
      const double until = n % 7 == 0 ? 45.0 : 200.0;
      model.cast(ray, 0, static_cast<float>(until), hits);
      const Marched truth = march(voxels, alphas, ray, until);
      ASSERT_EQ(hits.has_front, truth.t >= 0) << model_number << " ray " << n;
      double depth = 0;
      float last = 0;
      for (const StickLayer& layer : hits.layers) {
        EXPECT_LE(last, layer.t);
        EXPECT_LT(layer.t, layer.end_t + 1e-6F);
        last = layer.end_t;
        depth -= std::log1p(-static_cast<double>(layer.opacity));
      }
      EXPECT_NEAR(depth, truth.depth, 1e-5 * (1 + truth.depth));
      layered += hits.layers.empty() ? 0 : 1;
      if (!hits.has_front) continue;
      ++met;
      EXPECT_NEAR(static_cast<double>(hits.front.t), truth.t, 2e-6 * (1 + truth.t));
      EXPECT_EQ(glm::ivec3(hits.front.place[0], hits.front.place[1], hits.front.place[2]), truth.voxel) << n;
    }
  }
  EXPECT_GT(met, 5000);
  EXPECT_GT(layered, 1500);
}

}  // namespace
}  // namespace objects
