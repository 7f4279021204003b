#include "objects/model/weld.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace objects {

std::vector<std::uint32_t> weld(const Mesh& mesh) {
  const std::size_t count = mesh.positions_m.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t n) {
    const glm::vec3& p = mesh.positions_m[n];
    return std::make_tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::make_pair(key(a), a) < std::make_pair(key(b), b);
  });
  std::vector<std::uint32_t> places(count);
  for (std::size_t n = 0; n < count; ++n)
    places[order[n]] = n > 0 && key(order[n]) == key(order[n - 1]) ? places[order[n - 1]] : order[n];
  return places;
}

std::vector<EdgeUse> edge_uses(const Mesh& mesh, const std::vector<std::uint32_t>& places) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const glm::uvec3& t = mesh.triangles[n];
    const glm::uvec3 at(places[t.x], places[t.y], places[t.z]);
    if (at.x == at.y || at.y == at.z || at.z == at.x) continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = at[k];
      const std::uint32_t b = at[(k + 1) % 3];
      uses.push_back(
          {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(n), static_cast<std::uint8_t>(k), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

}  // namespace objects
