#include "objects/levels/manifold.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <tuple>

#include "objects/model/normals.h"
#include "objects/model/weld.h"

namespace objects {

namespace {

// Triangles of an edge beyond these stay apart, as pairs of them all would take too long.
constexpr std::size_t kMostTrianglesOfPairedEdge = 32;

struct EdgePair {
  std::size_t a;  // indices of uses
  std::size_t b;
  double cosine;
};

void pair_up(const Mesh& mesh, const std::vector<EdgeUse>& uses, std::size_t first, std::size_t last,
             std::vector<EdgePair>& pairs) {
  const auto is_opposite = [&](std::size_t a, std::size_t b) {
    return uses[a].is_forward != uses[b].is_forward;
  };
  if (last - first == 2) {
    if (is_opposite(first, first + 1)) pairs.push_back({first, first + 1, 1});
    return;
  }
  last = std::min(last, first + kMostTrianglesOfPairedEdge);
  std::vector<EdgePair> candidates;
  for (std::size_t a = first; a < last; ++a) {
    for (std::size_t b = a + 1; b < last; ++b) {
      if (!is_opposite(a, b)) continue;
      const glm::dvec3 na = area_normal(mesh, uses[a].triangle);
      const glm::dvec3 nb = area_normal(mesh, uses[b].triangle);
      const double size = glm::length(na) * glm::length(nb);
      candidates.push_back({a, b, size > 0 ? glm::dot(na, nb) / size : -2});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const EdgePair& p, const EdgePair& q) {
    return std::tie(q.cosine, p.a, p.b) < std::tie(p.cosine, q.a, q.b);
  });
  std::vector<bool> is_taken(last - first, false);
  for (const EdgePair& pair : candidates) {
    if (is_taken[pair.a - first] || is_taken[pair.b - first]) continue;
    is_taken[pair.a - first] = is_taken[pair.b - first] = true;
    pairs.push_back(pair);
  }
}

}  // namespace

Manifold make_manifold(const Mesh& mesh) {
  const std::vector<EdgeUse> uses = edge_uses(mesh, weld(mesh));
  std::vector<EdgePair> pairs;
  for_each_edge(uses, [&](std::size_t first, std::size_t last) { pair_up(mesh, uses, first, last, pairs); });

  std::vector<bool> is_used(mesh.triangles.size(), false);
  for (const EdgeUse& use : uses) is_used[use.triangle] = true;
  std::vector<bool> is_alone(mesh.triangles.size(), false);
  const auto corner = [](const EdgeUse& use, std::size_t end) {
    return 3 * std::size_t{use.triangle} + (use.corner + end) % 3;
  };
  // Two triangles that stay apart at an edge can still be connected around both its ends. They may not run
  // along it in the same direction: one of them is then set apart, which can set its neighbours apart from each
  // other.
  while (true) {
    JoinedSets sets(3 * mesh.triangles.size());
    for (const EdgePair& pair : pairs) {
      const EdgeUse& a = uses[pair.a];
      const EdgeUse& b = uses[pair.b];
      if (is_alone[a.triangle] || is_alone[b.triangle]) continue;
      sets.join(corner(a, 0), corner(b, 1));
      sets.join(corner(a, 1), corner(b, 0));
    }
    using Side = std::tuple<std::size_t, std::size_t, std::uint32_t>;
    std::vector<Side> sides;
    sides.reserve(uses.size());
    for (const EdgeUse& use : uses)
      sides.emplace_back(sets.find(corner(use, 0)), sets.find(corner(use, 1)), use.triangle);
    std::sort(sides.begin(), sides.end());
    bool is_done = true;
    for (std::size_t n = 1; n < sides.size(); ++n) {
      const auto& [from, to, triangle] = sides[n];
      if (from != std::get<0>(sides[n - 1]) || to != std::get<1>(sides[n - 1])) continue;
      is_alone[triangle] = true;
      is_done = false;
    }
    if (!is_done) continue;

    Manifold result;
    constexpr std::uint32_t kNone = ~0U;
    std::vector<std::uint32_t> node_of(3 * mesh.triangles.size(), kNone);
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
      if (!is_used[n]) continue;
      glm::uvec3 nodes(0);
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& node = node_of[sets.find(3 * n + static_cast<std::size_t>(k))];
        if (node == kNone) {
          node = static_cast<std::uint32_t>(result.vertex_of.size());
          result.vertex_of.push_back(mesh.triangles[n][k]);
        }
        nodes[k] = node;
      }
      result.triangles.push_back(nodes);
      result.triangle_of.push_back(static_cast<std::uint32_t>(n));
    }
    return result;
  }
}

}  // namespace objects
