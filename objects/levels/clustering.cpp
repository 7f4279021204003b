#include "objects/levels/clustering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "objects/model/normals.h"

namespace objects {

namespace {

// Weighs the distance from the mean of a cell's corners against that from their planes, so that there is one best place.
constexpr double kTowardsMean = 1e-3;
constexpr double kMostCells = 1 << 20;

struct ClusterCell {
  glm::dvec3 low_m{0, 0, 0};
  glm::dvec3 sum_m{0, 0, 0};  // of corners, weighted by area
  double weight = 0;
  glm::dmat3 planes{0.0};
  glm::dvec3 offsets{0, 0, 0};
  glm::vec3 place_m{0, 0, 0};
};

struct ClusterTriangle {
  std::array<std::uint32_t, 3> nodes{};  // of cells
  std::uint32_t triangle = 0;
  double area = 0;
};

glm::vec3 place_of(const ClusterCell& cell, double cell_m) {
  const glm::dvec3 mean_m = cell.sum_m / cell.weight;
  // The planes about the mean: minimizes sum w (n (d - e))^2 + w kTowardsMean d^2.
  const glm::dmat3 all = cell.planes + glm::dmat3(kTowardsMean * cell.weight);
  const glm::dvec3 moved_m = glm::inverse(all) * (cell.offsets - cell.planes * mean_m);
  const glm::dvec3 place_m = mean_m + moved_m;
  const bool is_finite = std::isfinite(place_m.x) && std::isfinite(place_m.y) && std::isfinite(place_m.z);
  return glm::vec3(glm::clamp(is_finite ? place_m : mean_m, cell.low_m, cell.low_m + cell_m));
}

// The corner with the least number first; the side that counts of triangles with two sides is that of ascending numbers.
std::array<std::uint32_t, 3> key_of(std::array<std::uint32_t, 3> nodes, bool is_double_sided) {
  std::rotate(nodes.begin(), std::min_element(nodes.begin(), nodes.end()), nodes.end());
  if (is_double_sided && nodes[1] > nodes[2]) std::swap(nodes[1], nodes[2]);
  return nodes;
}

Mesh without_looks(const Mesh& mesh) {
  Mesh result = mesh;
  result.normals.clear();
  result.textures.clear();
  return result;
}

}  // namespace

Mesh cluster(const Mesh& mesh, double cell_m) {
  if (mesh.triangles.empty() || !(cell_m > 0)) return without_looks(mesh);
  glm::dvec3 low_m(mesh.positions_m[mesh.triangles[0].x]);
  glm::dvec3 high_m = low_m;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      low_m = glm::min(low_m, glm::dvec3(mesh.positions_m[t[k]]));
      high_m = glm::max(high_m, glm::dvec3(mesh.positions_m[t[k]]));
    }
  }
  const glm::dvec3 size_m = high_m - low_m;
  if (std::max({size_m.x, size_m.y, size_m.z}) / cell_m >= kMostCells) return without_looks(mesh);
  // Half a cell beyond, so that a mesh that is as thick as some cells is not cut at its sides.
  low_m -= 0.5 * cell_m;

  std::vector<ClusterCell> cells;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers;
  const auto cell_of = [&](const glm::dvec3& p) {
    const glm::dvec3 at = glm::floor((p - low_m) / cell_m);
    const auto key = (static_cast<std::uint64_t>(at.x) << 42U) | (static_cast<std::uint64_t>(at.y) << 21U) |
                     static_cast<std::uint64_t>(at.z);
    const auto [entry, is_new] = numbers.try_emplace(key, static_cast<std::uint32_t>(cells.size()));
    if (is_new) cells.push_back({.low_m = low_m + cell_m * at});
    return entry->second;
  };
  std::vector<ClusterTriangle> left;
  for (std::uint32_t n = 0; n < mesh.triangles.size(); ++n) {
    const glm::dvec3 doubled = area_normal(mesh, n);
    const double area = 0.5 * glm::length(doubled);
    if (!(area > 0)) continue;
    const glm::dvec3 normal = doubled / (2 * area);
    ClusterTriangle triangle{{}, n, area};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 p(mesh.positions_m[mesh.triangles[n][static_cast<int>(k)]]);
      triangle.nodes[k] = cell_of(p);
      ClusterCell& cell = cells[triangle.nodes[k]];
      cell.sum_m += area * p;
      cell.weight += area;
      cell.planes += area * glm::outerProduct(normal, normal);
      cell.offsets += area * glm::dot(normal, p) * normal;
    }
    const auto& [a, b, c] = triangle.nodes;
    if (a != b && b != c && c != a) left.push_back(triangle);
  }
  for (ClusterCell& cell : cells) cell.place_m = place_of(cell, cell_m);

  // Those that fall together follow each other, the largest first.
  const auto key = [&](const ClusterTriangle& t) {
    return key_of(t.nodes, mesh.material_table[mesh.materials[t.triangle]].double_sided);
  };
  std::sort(left.begin(), left.end(), [&](const ClusterTriangle& a, const ClusterTriangle& b) {
    return std::make_tuple(key(a), -a.area, a.triangle) < std::make_tuple(key(b), -b.area, b.triangle);
  });
  left.erase(std::unique(left.begin(), left.end(),
                         [&](const ClusterTriangle& a, const ClusterTriangle& b) { return key(a) == key(b); }),
             left.end());
  std::sort(left.begin(), left.end(),
            [](const ClusterTriangle& a, const ClusterTriangle& b) { return a.triangle < b.triangle; });

  Mesh result;
  result.material_table = mesh.material_table;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices;  // of (cell, vertex with the corner's looks)
  const bool is_plain = mesh.uvs.empty() && mesh.colours.empty();
  for (const ClusterTriangle& t : left) {
    glm::uvec3 triangle(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t source = is_plain ? 0 : mesh.triangles[t.triangle][static_cast<int>(k)];
      const auto [entry, is_new] = vertices.try_emplace((std::uint64_t{t.nodes[k]} << 32U) | source,
                                                        static_cast<std::uint32_t>(result.positions_m.size()));
      if (is_new) {
        result.positions_m.push_back(cells[t.nodes[k]].place_m);
        if (!mesh.uvs.empty()) result.uvs.push_back(mesh.uvs[source]);
        if (!mesh.colours.empty()) result.colours.push_back(mesh.colours[source]);
      }
      triangle[static_cast<int>(k)] = entry->second;
    }
    result.triangles.push_back(triangle);
    result.materials.push_back(mesh.materials[t.triangle]);
    if (area_normal(result, result.triangles.size() - 1) == glm::dvec3(0.0)) {
      result.triangles.pop_back();
      result.materials.pop_back();
    }
  }
  return result;
}

}  // namespace objects
