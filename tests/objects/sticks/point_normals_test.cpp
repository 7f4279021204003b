// Normals of points without normals, against the shapes that the points are of.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "objects/points/plane_fit.h"
#include "objects/points/sky_view.h"
#include "objects/points/voxelise_points.h"
#include "tests/objects/sticks/point_shapes.h"

namespace objects {
namespace {

glm::dvec3 normal_of(const StickVoxel& voxel) {
  return glm::normalize(glm::dvec3(voxel.normal[0], voxel.normal[1], voxel.normal[2]));
}

glm::dvec3 centre_m(const VoxelGrid& voxels, std::uint64_t place) {
  return glm::dvec3(voxels.grid().corner_m) +
         static_cast<double>(voxels.grid().voxel_m) * (glm::dvec3(voxels.voxel_of(place)) + 0.5);
}

// Returns the share of coloured voxels whose normals point in the true direction to within some 25 degrees.
template <class Truth>
double share_of_true_normals(const VoxelGrid& voxels, const Truth& truth) {
  int good = 0;
  int all = 0;
  for (const VoxelGrid::Coloured& c : voxels.coloured()) {
    const glm::dvec3 expected = truth(centre_m(voxels, c.place));
    if (expected == glm::dvec3(0)) continue;
    ++all;
    good += glm::dot(normal_of(c.voxel), expected) > 0.9 ? 1 : 0;
  }
  EXPECT_GT(all, 500);
  return static_cast<double>(good) / all;
}

TEST(PlaneFit, FindsPlanes) {
  ::test_support::Random random(1);
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 normal = random.direction();
    const glm::dvec3 side = glm::normalize(glm::cross(normal, random.direction()));
    const glm::dvec3 other = glm::cross(normal, side);
    const glm::dvec3 middle = 10.0 * random.direction();
    PlaneFit fit;
    for (int k = 0; k < 12; ++k) {
      const double u = random.uniform(-2, 2);
      const double v = random.uniform(-2, 2);
      fit.add(middle + u * side + v * other);
    }
    ASSERT_TRUE(fit.normal());
    EXPECT_NEAR(std::abs(glm::dot(*fit.normal(), normal)), 1, 1e-6);
  }
}

TEST(PlaneFit, LinesAndPointsLeaveItUndecided) {
  PlaneFit fit;
  EXPECT_FALSE(fit.normal());
  for (int n = 0; n < 5; ++n) {
    fit.add({1.0 * n, 2.0 * n, -0.5 * n});
    EXPECT_FALSE(fit.normal()) << n;
  }
  fit.add({1, 0, 0});
  EXPECT_TRUE(fit.normal());
  PlaneFit same;
  for (int n = 0; n < 5; ++n) same.add({0.3, 0.2, 0.1});
  EXPECT_FALSE(same.normal());
}

TEST(SkyView, IsThatOfSteps) {
  ::test_support::Random random(2);
  for (int n = 0; n < 8; ++n) {
    const int height = n % 3 == 0 ? 64 : random.integer(1, 70);
    VoxelGrid voxels({random.integer(1, 8), random.integer(1, 8), height, 1});
    const StickGrid& g = voxels.grid();
    for (int k = 0; k < random.integer(0, 30); ++k) {
      const int x = random.integer(0, g.columns_x - 1);
      const int y = random.integer(0, g.columns_y - 1);
      voxels.set(x, y, random.integer(0, g.height - 1));
    }
    for (const glm::ivec3& step : kSkySteps) {
      const VoxelGrid view = sky_view(voxels, step);
      for (int x = -3; x < g.columns_x + 3; ++x) {
        for (int y = -3; y < g.columns_y + 3; ++y) {
          for (int z = -3; z < g.height + 3; ++z) {
            bool is_free = true;
            for (glm::ivec3 at(x, y, z); is_free && at.z < g.height; at += step)
              is_free = !voxels.is_set(at.x, at.y, at.z);
            ASSERT_EQ(sees_sky(view, {x, y, z}, step), is_free) << x << " " << y << " " << z;
          }
        }
      }
    }
  }
}

TEST(PointNormals, OfClosedShellsPointOutward) {
  const VoxelGrid voxels = voxelise_points(point_shapes::sphere_points(30'000, 3), {.voxels_longest = 48});
  EXPECT_GT(share_of_true_normals(voxels, [](const glm::dvec3& p) { return glm::normalize(p); }), 0.999);
}

TEST(PointNormals, OfSparsePointsPointOutward) {
  const VoxelGrid voxels =
      voxelise_points(point_shapes::sphere_points(3000, 4), {.voxels_longest = 64, .close_voxels = 4});
  EXPECT_GT(share_of_true_normals(voxels, [](const glm::dvec3& p) { return glm::normalize(p); }), 0.98);
}

TEST(PointNormals, OfOpenGroundPointUp) {
  const VoxelGrid voxels = voxelise_points(point_shapes::plane_points(20'000, 5), {.voxels_longest = 60});
  const glm::dvec3 up = glm::normalize(glm::dvec3(-0.4, 0.2, 1));
  EXPECT_GT(share_of_true_normals(voxels, [&](const glm::dvec3&) { return up; }), 0.999);
}

// A bowl is open to the sky although its middle lies above its ground; a dome that is open below has no inside.
TEST(PointNormals, OfBowlsAndDomesFaceTheOpenSide) {
  Mesh bowl;
  Mesh dome;
  for (const glm::vec3& p : point_shapes::sphere_points(40'000, 6).positions_m) {
    if (p.z < -0.2F) bowl.positions_m.push_back(p);
    if (p.z > -0.2F) dome.positions_m.push_back(p);
  }
  EXPECT_GT(share_of_true_normals(voxelise_points(bowl, {.voxels_longest = 48}),
                                  [](const glm::dvec3& p) { return -glm::normalize(p); }),
            0.999);
  EXPECT_GT(share_of_true_normals(voxelise_points(dome, {.voxels_longest = 48}),
                                  [](const glm::dvec3& p) { return glm::normalize(p); }),
            0.999);
}

TEST(PointNormals, OfOverhangsPointDown) {
  Mesh points = point_shapes::ledge_points(30'000, 7);
  points.normals.clear();
  const VoxelGrid voxels = voxelise_points(points, {.voxels_longest = 80});
  // Near the edges, within some three voxels, nothing is asked for.
  const auto truth = [](const glm::dvec3& p) -> glm::dvec3 {
    constexpr double kEdge_m = 0.07;
    if (p.y < kEdge_m || p.y > 2 - kEdge_m) return glm::dvec3(0);
    if (std::abs(p.z) < 0.03 && p.x < -kEdge_m) return {0, 0, 1};
    if (std::abs(p.z - 0.9) < 0.03 && p.x > -0.3 + kEdge_m) return {0, 0, 1};
    if (std::abs(p.z - 0.5) < 0.03 && p.x > -0.3 + kEdge_m && p.x < -kEdge_m) return {0, 0, -1};
    if (std::abs(p.x) < 0.03 && p.z > kEdge_m && p.z < 0.5 - kEdge_m) return {-1, 0, 0};
    if (std::abs(p.x + 0.3) < 0.03 && p.z > 0.5 + kEdge_m && p.z < 0.9 - kEdge_m) return {-1, 0, 0};
    return glm::dvec3(0);
  };
  EXPECT_GT(share_of_true_normals(voxels, truth), 0.99);
}

TEST(PointNormals, ThoseOfPointsCountAndServeTheirNeighbours) {
  Mesh points = point_shapes::plane_points(8000, 8);
  const glm::vec3 down = -glm::normalize(glm::vec3(-0.4F, 0.2F, 1));
  for (std::size_t n = 0; n < points.positions_m.size(); ++n)
    points.normals.push_back(n % 2 == 0 ? down : glm::vec3(0));
  const VoxelGrid voxels = voxelise_points(points, {.voxels_longest = 50});
  EXPECT_GT(share_of_true_normals(voxels, [&](const glm::dvec3&) { return glm::dvec3(down); }), 0.97);
}

}  // namespace
}  // namespace objects
