// Points of surfaces of meshes, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "objects/model/distance_tree.h"
#include "objects/model/mesh.h"
#include "objects/model/normals.h"

namespace objects::test_support {

struct SoupTriangle {
  glm::vec3 a;
  glm::vec3 b;
  glm::vec3 c;
};

// Returns a mesh of triangles that share no vertices.
inline Mesh soup(const std::vector<SoupTriangle>& triangles) {
  Mesh mesh;
  mesh.material_table = {Material{}};
  for (const SoupTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
    mesh.positions_m.insert(mesh.positions_m.end(), {t.a, t.b, t.c});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.materials.push_back(0);
  }
  return mesh;
}

// Returns the positions and triangles of two meshes together.
inline Mesh joined(Mesh a, const Mesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions_m.size());
  a.positions_m.insert(a.positions_m.end(), b.positions_m.begin(), b.positions_m.end());
  for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + first);
  a.normals.clear();
  a.materials.assign(a.triangles.size(), 0);
  a.material_table = {Material{}};
  return a;
}

// Triangles of up to size_m in a cube of twice that, some of them long or without area.
inline Mesh random_soup(std::mt19937& random, int count, float size_m) {
  std::uniform_real_distribution<float> any(-size_m, size_m);
  const auto point = [&] { return glm::vec3(any(random), any(random), any(random)); };
  std::vector<SoupTriangle> triangles;
  for (int n = 0; n < count; ++n) {
    const glm::vec3 at = point();
    SoupTriangle t{at, at + 0.5F * point(), at + 0.5F * point()};
    if (n % 7 == 3) t.c = t.b + 0.01F * point();
    if (n % 11 == 5) t.c = t.b;
    triangles.push_back(t);
  }
  return soup(triangles);
}

// Returns the largest distance of so many points of a mesh, spread by area and with all corners, from another
// one: at most the true one.
inline double farthest_sample_m(const Mesh& mesh, const Mesh& other, std::size_t samples, unsigned seed) {
  const DistanceTree tree(other);
  std::vector<double> areas;
  double sum = 0;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    areas.push_back(sum += glm::length(area_normal(mesh, n)));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  double farthest_m = 0;
  std::uint32_t hint = 0;
  const auto add = [&](const glm::dvec3& p) {
    const DistanceTree::Nearest nearest = tree.nearest(p, hint);
    hint = nearest.triangle;
    farthest_m = std::max(farthest_m, nearest.distance_m);
  };
  const auto corner = [&](std::size_t n, int k) { return glm::dvec3(mesh.positions_m[mesh.triangles[n][k]]); };
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    for (int k = 0; k < 3; ++k) add(corner(n, k));
  for (std::size_t s = 0; s < samples; ++s) {
    const auto n = static_cast<std::size_t>(
        std::lower_bound(areas.begin(), areas.end() - 1, any(random) * sum) - areas.begin());
    const double u = std::sqrt(any(random));
    const double v = any(random);
    add((1 - u) * corner(n, 0) + u * (1 - v) * corner(n, 1) + u * v * corner(n, 2));
  }
  return farthest_m;
}

}  // namespace objects::test_support
