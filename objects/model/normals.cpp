#include "objects/model/normals.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "objects/model/weld.h"

namespace objects {

namespace {

// Of an edge with many triangles, as where two leaves touch, no more are compared with each other.
constexpr std::size_t kMostTrianglesOfSmoothEdge = 8;

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::dvec3(0.0);
}

template <class T>
void repeat_entry(std::vector<T>& entries, std::uint32_t n) {
  if (entries.empty()) return;
  const T entry = entries[n];
  entries.push_back(entry);
}

}  // namespace

glm::dvec3 area_normal(const Mesh& mesh, std::size_t triangle) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions_m[t.x]);
  return glm::cross(glm::dvec3(mesh.positions_m[t.y]) - a, glm::dvec3(mesh.positions_m[t.z]) - a);
}

void add_normals(Mesh& mesh) {
  const std::vector<EdgeUse> uses = edge_uses(mesh, weld(mesh));
  std::vector<glm::dvec3> areas(mesh.triangles.size());
  std::vector<glm::dvec3> units(mesh.triangles.size());
  for (std::size_t n = 0; n < areas.size(); ++n) {
    areas[n] = area_normal(mesh, n);
    units[n] = unit_or_zero(areas[n]);
  }
  JoinedSets sets(3 * mesh.triangles.size());
  const auto corner_at_low = [](const EdgeUse& use, bool is_low) {
    return 3 * std::size_t{use.triangle} + (use.corner + (use.is_forward == is_low ? 0U : 1U)) % 3;
  };
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    last = std::min(last, first + kMostTrianglesOfSmoothEdge);
    for (std::size_t a = first; a < last; ++a) {
      for (std::size_t b = a + 1; b < last; ++b) {
        if (glm::dot(units[uses[a].triangle], units[uses[b].triangle]) < kCosineOfSharp) continue;
        for (const bool is_low : {true, false})
          sets.join(corner_at_low(uses[a], is_low), corner_at_low(uses[b], is_low));
      }
    }
  });
  std::vector<glm::dvec3> sums(3 * mesh.triangles.size(), glm::dvec3(0.0));
  for (std::size_t n = 0; n < sums.size(); ++n) sums[sets.find(n)] += areas[n / 3];

  mesh.normals.assign(mesh.positions_m.size(), glm::vec3(0));
  constexpr std::size_t kNoSet = ~std::size_t{0};
  std::vector<std::size_t> set_of(mesh.positions_m.size(), kNoSet);
  std::unordered_map<std::uint64_t, std::uint32_t> copies;  // of (vertex, set)
  for (std::size_t n = 0; n < sums.size(); ++n) {
    std::uint32_t& vertex = mesh.triangles[n / 3][static_cast<int>(n % 3)];
    const std::size_t set = sets.find(n);
    if (set_of[vertex] == set) continue;
    if (set_of[vertex] != kNoSet) {
      const auto [copy, is_new] = copies.try_emplace((std::uint64_t{vertex} << 32U) | set,
                                                     static_cast<std::uint32_t>(mesh.positions_m.size()));
      if (is_new) {
        repeat_entry(mesh.positions_m, vertex);
        repeat_entry(mesh.uvs, vertex);
        repeat_entry(mesh.colours, vertex);
        repeat_entry(mesh.normals, vertex);
        set_of.push_back(set);
      }
      vertex = copy->second;
      if (!is_new) continue;
    }
    set_of[vertex] = set;
    glm::dvec3 normal = unit_or_zero(sums[set]);
    if (normal == glm::dvec3(0.0)) normal = units[n / 3];
    if (normal == glm::dvec3(0.0)) normal = {0, 0, 1};
    mesh.normals[vertex] = glm::vec3(normal);
  }
  for (glm::vec3& normal : mesh.normals)
    if (normal == glm::vec3(0)) normal = {0, 0, 1};  // of vertices without a triangle
}

}  // namespace objects
