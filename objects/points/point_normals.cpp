#include "objects/points/point_normals.h"

#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>

#include "objects/points/outward_normals.h"
#include "objects/points/plane_fit.h"
#include "objects/points/voxel_cube.h"

namespace objects {

namespace {

constexpr int kLeastReach = 2;  // of the cube that is looked into, in voxels from its middle one
constexpr std::size_t kEnoughNeighbours = 8;

VoxelNormal plane_of(const PointVoxels& points, const PointSurroundings& around, std::uint32_t number) {
  const glm::dvec3 own = points.middle(number);
  const glm::ivec3 voxel = around.held.voxel_of(points.places()[number]);
  PlaneFit fit;
  glm::dvec3 sum(0);
  int reach = kLeastReach;
  for (;; ++reach) {
    fit = {};
    sum = glm::dvec3(0);
    for_each_in_cube(around.held, voxel, reach, [&](std::uint64_t place) {
      const glm::dvec3 other = points.middle(points.number(place)) - own;
      fit.add(other);
      sum += other;
    });
    if (fit.size() > kEnoughNeighbours || reach == kLeastReach + 2 * around.close_voxels) break;
  }
  if (const std::optional<glm::dvec3> normal = fit.normal()) return {*normal, reach, NormalState::kTwoSided};
  return {glm::length(sum) > 1e-6 ? -glm::normalize(sum) : glm::dvec3(0, 0, 1), reach, NormalState::kAlone};
}

}  // namespace

std::vector<glm::vec3> point_normals(const PointVoxels& points, const PointSurroundings& around) {
  std::vector<VoxelNormal> normals;
  normals.reserve(points.size());
  for (std::uint32_t n = 0; n < points.size(); ++n) {
    const glm::vec3 given = points.normal(n);
    if (given != glm::vec3(0))
      normals.push_back({glm::dvec3(given), kLeastReach, NormalState::kOutward});
    else
      normals.push_back(plane_of(points, around, n));
  }
  turn_outward(points, around, normals);
  std::vector<glm::vec3> outward;
  outward.reserve(normals.size());
  for (const VoxelNormal& n : normals) outward.emplace_back(n.normal);
  return outward;
}

}  // namespace objects
