// Point clouds of simple shapes, and what becomes of their voxels by definition, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <set>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/sticks/voxel_grid.h"
#include "tests/support/support.h"

namespace objects::point_shapes {

using Place = std::array<int, 3>;
using Places = std::set<Place>;

inline Places places_of(const VoxelGrid& voxels) {
  Places places;
  for (int y = 0; y < voxels.grid().columns_y; ++y)
    for (int x = 0; x < voxels.grid().columns_x; ++x)
      for (int z = 0; z < voxels.grid().height; ++z)
        if (voxels.is_set(x, y, z)) places.insert({x, y, z});
  return places;
}

// Returns the least distance of a voxel from others: the largest of the three differences.
inline int distance(const Places& places, const Place& from) {
  int least = std::numeric_limits<int>::max();
  for (const Place& p : places)
    least = std::min(least,
                     std::max({std::abs(p[0] - from[0]), std::abs(p[1] - from[1]), std::abs(p[2] - from[2])}));
  return least;
}

template <class Visit>
void for_each_near(const Place& p, int reach, const Visit& visit) {
  for (int x = p[0] - reach; x <= p[0] + reach; ++x)
    for (int y = p[1] - reach; y <= p[1] + reach; ++y)
      for (int z = p[2] - reach; z <= p[2] + reach; ++z) visit(Place{x, y, z});
}

// Returns all that are neighbours of some.
inline Places dilated(const Places& places, int reach) {
  Places wide;
  for (const Place& p : places) for_each_near(p, reach, [&](const Place& q) { wide.insert(q); });
  return wide;
}

// Returns those all of whose neighbours are there.
inline Places eroded(const Places& places, int reach) {
  Places result;
  for (const Place& p : places) {
    bool is_kept = true;
    for_each_near(p, reach, [&](const Place& q) { is_kept = is_kept && places.contains(q); });
    if (is_kept) result.insert(p);
  }
  return result;
}

// Adds what no path through sides of empty voxels joins with the outside. Voxels lie between two corners, with these.
inline Places with_inside(const Places& places, const Place& low, const Place& high) {
  const Place start{low[0] - 1, low[1] - 1, low[2] - 1};
  Places outside{start};
  std::vector<Place> open{start};
  while (!open.empty()) {
    const Place p = open.back();
    open.pop_back();
    for (std::size_t k = 0; k < 6; ++k) {
      Place q = p;
      q[k / 2] += k % 2 == 0 ? 1 : -1;
      if (q[k / 2] < low[k / 2] - 1 || q[k / 2] > high[k / 2] + 1 || places.contains(q) ||
          !outside.insert(q).second)
        continue;
      open.push_back(q);
    }
  }
  Places all;
  for (int x = low[0]; x <= high[0]; ++x)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int z = low[2]; z <= high[2]; ++z)
        if (!outside.contains({x, y, z})) all.insert({x, y, z});
  return all;
}

// Returns what close_gaps() makes of voxels.
inline Places closed(const Places& places, const StickGrid& grid, int reach) {
  const Place low{-reach, -reach, -reach};
  const Place high{grid.columns_x + reach - 1, grid.columns_y + reach - 1, grid.height + reach - 1};
  return eroded(with_inside(dilated(places, reach), low, high), reach);
}

// Returns the voxel of a grid that holds a point.
inline Place voxel_with(const StickGrid& g, const glm::vec3& p) {
  const glm::dvec3 at = (glm::dvec3(p) - glm::dvec3(g.corner_m)) / static_cast<double>(g.voxel_m);
  return {static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)),
          static_cast<int>(std::floor(at.z))};
}

inline Mesh sphere_points(int count, std::uint64_t seed, float radius_m = 1) {
  ::test_support::Random random(seed);
  Mesh points;
  for (int n = 0; n < count; ++n) points.positions_m.push_back(radius_m * glm::vec3(random.direction()));
  return points;
}

// A square of 2 m, tilted.
inline Mesh plane_points(int count, std::uint64_t seed) {
  ::test_support::Random random(seed);
  Mesh points;
  for (int n = 0; n < count; ++n) {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    points.positions_m.emplace_back(x, y, 0.4 * x - 0.2 * y);
  }
  return points;
}

// Ground, a wall, a ceiling 0.3 m deep above the ground, its front and the ground above, all 2 m wide: what a scan of a
// ledge sees. Normals are the true ones.
inline Mesh ledge_points(int per_m2, std::uint64_t seed) {
  ::test_support::Random random(seed);
  Mesh points;
  const auto add = [&](const glm::dvec3& corner, const glm::dvec3& side, const glm::dvec3& normal) {
    const int count = static_cast<int>(2 * per_m2 * glm::length(side));
    for (int n = 0; n < count; ++n) {
      const double u = random.uniform(0, 1);
      const double v = random.uniform(0, 1);
      points.positions_m.emplace_back(corner + u * side + glm::dvec3(0, 2 * v, 0));
      points.normals.emplace_back(normal);
    }
  };
  add({-1, 0, 0}, {1, 0, 0}, {0, 0, 1});
  add({0, 0, 0}, {0, 0, 0.5}, {-1, 0, 0});
  add({-0.3, 0, 0.5}, {0.3, 0, 0}, {0, 0, -1});
  add({-0.3, 0, 0.5}, {0, 0, 0.4}, {-1, 0, 0});
  add({-0.3, 0, 0.9}, {1.3, 0, 0}, {0, 0, 1});
  return points;
}

inline Mesh any_points(int count, std::uint64_t seed) {
  ::test_support::Random random(seed);
  Mesh points;
  for (int n = 0; n < count; ++n) {
    const double x = random.uniform(0, 3);
    const double y = random.uniform(-1, 1);
    points.positions_m.emplace_back(x, y, random.uniform(5, 6));
  }
  return points;
}

}  // namespace objects::point_shapes
