#include "objects/levels/mesh_parts.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "objects/model/distance_tree.h"
#include "objects/model/normals.h"
#include "objects/model/weld.h"

namespace objects {

namespace {

// Surfaces that grow, in trees of which each is at most half as large as the one before.
class GrowingSurface {
 public:
  explicit GrowingSurface(const Mesh& mesh) : mesh_(mesh) {}

  void add(std::vector<std::uint32_t> triangles) {
    while (!sets_.empty() && sets_.back().size() < 2 * triangles.size()) {
      triangles.insert(triangles.end(), sets_.back().begin(), sets_.back().end());
      sets_.pop_back();
      trees_.pop_back();
    }
    Mesh part;
    for (const std::uint32_t n : triangles) {
      const auto first = static_cast<std::uint32_t>(part.positions_m.size());
      for (int k = 0; k < 3; ++k) part.positions_m.push_back(mesh_.positions_m[mesh_.triangles[n][k]]);
      part.triangles.emplace_back(first, first + 1, first + 2);
    }
    trees_.emplace_back(part);
    sets_.push_back(std::move(triangles));
    hints_.assign(trees_.size(), 0);
  }

  bool is_within(const glm::dvec3& point_m, double distance_m) {
    for (std::size_t n = 0; n < trees_.size(); ++n) {
      const DistanceTree::Nearest nearest = trees_[n].nearest(point_m, hints_[n]);
      hints_[n] = nearest.triangle;
      if (nearest.distance_m <= distance_m) return true;
    }
    return false;
  }

 private:
  const Mesh& mesh_;
  std::vector<std::vector<std::uint32_t>> sets_;
  std::vector<DistanceTree> trees_;
  std::vector<std::uint32_t> hints_;
};

bool lies_near(const Mesh& mesh, const std::vector<std::uint32_t>& part, GrowingSurface& surface,
               double within_m) {
  return std::all_of(part.begin(), part.end(), [&](std::uint32_t n) {
    glm::dvec3 middle(0);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 corner(mesh.positions_m[mesh.triangles[n][k]]);
      if (!surface.is_within(corner, within_m)) return false;
      middle += corner / 3.0;
    }
    return surface.is_within(middle, within_m);
  });
}

}  // namespace

MeshParts find_parts(const Mesh& mesh) {
  const std::vector<std::uint32_t> places = weld(mesh);
  JoinedSets sets(mesh.positions_m.size());
  for (const glm::uvec3& t : mesh.triangles) {
    sets.join(places[t.x], places[t.y]);
    sets.join(places[t.x], places[t.z]);
  }
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> number(mesh.positions_m.size(), kNone);
  MeshParts parts;
  for (const glm::uvec3& t : mesh.triangles) {
    std::uint32_t& n = number[sets.find(places[t.x])];
    if (n == kNone) n = static_cast<std::uint32_t>(parts.count++);
    parts.of.push_back(n);
  }
  return parts;
}

Mesh without_near_parts(const Mesh& mesh, double within_m) {
  const MeshParts parts = find_parts(mesh);
  std::vector<std::vector<std::uint32_t>> triangles(parts.count);
  std::vector<double> areas(parts.count, 0.0);
  for (std::uint32_t n = 0; n < mesh.triangles.size(); ++n) {
    const double area = glm::length(area_normal(mesh, n));
    if (!(area > 0)) continue;
    triangles[parts.of[n]].push_back(n);
    areas[parts.of[n]] += area;
  }
  std::vector<std::uint32_t> order(parts.count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return areas[a] > areas[b]; });
  GrowingSurface kept(mesh);
  std::vector<std::uint8_t> stays(parts.count, 0);
  for (const std::uint32_t part : order) {
    if (triangles[part].empty() || lies_near(mesh, triangles[part], kept, within_m)) continue;
    stays[part] = 1;
    kept.add(std::move(triangles[part]));
  }

  Mesh result;
  result.material_table = mesh.material_table;
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> vertex_of(mesh.positions_m.size(), kNone);
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    if (stays[parts.of[n]] == 0 || area_normal(mesh, n) == glm::dvec3(0.0)) continue;
    glm::uvec3 t = mesh.triangles[n];
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& vertex = vertex_of[t[k]];
      if (vertex == kNone) {
        vertex = static_cast<std::uint32_t>(result.positions_m.size());
        result.positions_m.push_back(mesh.positions_m[t[k]]);
        if (!mesh.uvs.empty()) result.uvs.push_back(mesh.uvs[t[k]]);
        if (!mesh.colours.empty()) result.colours.push_back(mesh.colours[t[k]]);
      }
      t[k] = vertex;
    }
    result.triangles.push_back(t);
    result.materials.push_back(mesh.materials[n]);
  }
  return result;
}

}  // namespace objects
