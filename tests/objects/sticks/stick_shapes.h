// Models of sticks of simple shapes, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "objects/sticks/build_sticks.h"

namespace objects::stick_shapes {

inline constexpr float kFar = std::numeric_limits<float>::infinity();

inline constexpr float kShapeEdge_m = 0.05F;
inline const StickGrid kShapeGrid{64, 64, 64, kShapeEdge_m, {-1.6F, -1.6F, -1.6F}};

// Distances from the surface of shapes around the origin, negative inside.
inline double sphere_distance(const glm::dvec3& p) { return glm::length(p) - 1.3; }
inline double box_distance(const glm::dvec3& p) {
  const glm::dvec3 d = glm::abs(p) - glm::dvec3(1.1, 0.7, 1.4);
  return glm::length(glm::max(d, 0.0)) + std::min(0.0, std::max({d.x, d.y, d.z}));
}
inline double cylinder_distance(const glm::dvec3& p) {
  const glm::dvec2 d(glm::length(glm::dvec2(p)) - 0.9, std::abs(p.z) - 1.2);
  return glm::length(glm::max(d, 0.0)) + std::min(0.0, std::max(d.x, d.y));
}
// Foot of radius 1.2 at z = -1.2, tip at z = 1.2. A bound of the distance outside, exact inside.
inline double cone_distance(const glm::dvec3& p) {
  const double side = (2.4 * glm::length(glm::dvec2(p)) + 1.2 * (p.z - 1.2)) / std::hypot(2.4, 1.2);
  return std::max(side, -1.2 - p.z);
}

// Returns the grid of the voxels whose centres have a negative distance.
inline VoxelGrid fill(const StickGrid& grid, const std::function<double(const glm::dvec3&)>& distance) {
  VoxelGrid voxels(grid);
  for (int y = 0; y < grid.columns_y; ++y) {
    for (int x = 0; x < grid.columns_x; ++x) {
      for (int z = 0; z < grid.height; ++z) {
        const glm::dvec3 centre =
            glm::dvec3(grid.corner_m) + static_cast<double>(grid.voxel_m) * (glm::dvec3(x, y, z) + 0.5);
        if (distance(centre) < 0) voxels.set(x, y, z);
      }
    }
  }
  return voxels;
}

inline glm::dvec3 any_direction(std::mt19937& random) {
  std::normal_distribution<double> normal(0, 1);
  const glm::dvec3 d(normal(random), normal(random), normal(random));
  return glm::normalize(d);
}

// Returns one of the six axes.
inline glm::dvec3 any_axis(std::mt19937& random) {
  glm::dvec3 d(0);
  const auto n = static_cast<int>(random() % 6);
  d[n / 2] = n % 2 == 0 ? 1 : -1;
  return d;
}

// Returns whether the voxels of a level hold a place.
inline bool holds(const StickModel::Level& level, const glm::ivec3& at) {
  const StickGrid& g = level.grid;
  if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= g.columns_x || at.y >= g.columns_y || at.z >= g.height)
    return false;
  const auto column =
      static_cast<std::size_t>(at.y) * static_cast<std::size_t>(g.columns_x) + static_cast<std::size_t>(at.x);
  const StickModel::Stick& stick = level.sticks[level.columns[column]];
  for (std::size_t n = 0; n < stick.runs; ++n) {
    const StickModel::Run& run = level.runs[stick.first_run + n];
    if (at.z >= run.begin && at.z < run.begin + run.length) return true;
  }
  return false;
}

inline std::size_t count_voxels(const StickModel::Level& level) {
  std::size_t sum = 0;
  for (const std::uint32_t s : level.columns) {
    const StickModel::Stick& stick = level.sticks[s];
    for (std::size_t n = 0; n < stick.runs; ++n) sum += level.runs[stick.first_run + n].length;
  }
  return sum;
}

}  // namespace objects::stick_shapes
