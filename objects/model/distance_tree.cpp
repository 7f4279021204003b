#include "objects/model/distance_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;

double distance2_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double length2 = glm::dot(along, along);
  const double s = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  const glm::dvec3 to = p - (a + s * along);
  return glm::dot(to, to);
}

// The regions around a triangle of Ericson, Real-Time Collision Detection, 5.1.5. The point that is measured
// always lies in the triangle, so that rounding can only make the distance larger.
double distance2_to_triangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& at) {
  const glm::dvec3& a = at[0];
  const glm::dvec3 ab = at[1] - a;
  const glm::dvec3 ac = at[2] - a;
  const glm::dvec3 ap = p - a;
  const double d1 = glm::dot(ab, ap);
  const double d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return glm::dot(ap, ap);
  const glm::dvec3 bp = p - at[1];
  const double d3 = glm::dot(ab, bp);
  const double d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return glm::dot(bp, bp);
  const glm::dvec3 cp = p - at[2];
  const double d5 = glm::dot(ab, cp);
  const double d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return glm::dot(cp, cp);
  const double vc = d1 * d4 - d3 * d2;
  const double vb = d5 * d2 - d1 * d6;
  const double va = d3 * d6 - d5 * d4;
  const double sum = va + vb + vc;
  if (va > 0 && vb > 0 && vc > 0 && sum > std::numeric_limits<double>::min()) {
    const glm::dvec3 to = ap - ab * (vb / sum) - ac * (vc / sum);
    return glm::dot(to, to);
  }
  if (vc <= 0 && d1 > 0 && d3 < 0) return distance2_to_segment(p, at[0], at[1]);
  if (vb <= 0 && d2 > 0 && d6 < 0) return distance2_to_segment(p, at[0], at[2]);
  if (va <= 0 && d4 > d3 && d5 > d6) return distance2_to_segment(p, at[1], at[2]);
  return std::min({distance2_to_segment(p, at[0], at[1]), distance2_to_segment(p, at[1], at[2]),
                   distance2_to_segment(p, at[2], at[0])});
}

}  // namespace

double distance_to_triangle(const glm::dvec3& point_m, const std::array<glm::dvec3, 3>& corners_m) {
  return std::sqrt(distance2_to_triangle(point_m, corners_m));
}

DistanceTree::DistanceTree(const Mesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  if (count == 0) return;
  std::vector<Triangle> unordered(count);
  std::vector<glm::vec3> middles(count);
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t n = 0; n < count; ++n) {
    Triangle& t = unordered[n];
    t.vertices = mesh.triangles[n];
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& p = mesh.positions_m[t.vertices[k]];
      t.at_m[static_cast<std::size_t>(k)] = p;
      for (int axis = 0; axis < 3; ++axis)
        extent_m_ = std::max(extent_m_, std::abs(static_cast<double>(p[axis])));
    }
    middles[n] = 0.5F * (glm::min(glm::min(t.at_m[0], t.at_m[1]), t.at_m[2]) +
                         glm::max(glm::max(t.at_m[0], t.at_m[1]), t.at_m[2]));
    order[n] = n;
  }
  triangles_ = std::move(unordered);
  nodes_.reserve(count);
  build(0, count, middles, order);
  std::vector<Triangle> ordered(count);
  for (std::uint32_t n = 0; n < count; ++n) ordered[n] = triangles_[order[n]];
  triangles_ = std::move(ordered);
}

// Which triangles each half gets, and their order in a leaf, must not depend on the library's nth_element.
void DistanceTree::build(std::uint32_t first, std::uint32_t count, std::vector<glm::vec3>& middles,
                         std::vector<std::uint32_t>& order) {
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  glm::vec3 low_m(std::numeric_limits<float>::max());
  glm::vec3 high_m(std::numeric_limits<float>::lowest());
  glm::vec3 low_middle_m = low_m;
  glm::vec3 high_middle_m = high_m;
  for (std::uint32_t n = first; n < first + count; ++n) {
    for (const glm::vec3& p : triangles_[order[n]].at_m) {
      low_m = glm::min(low_m, p);
      high_m = glm::max(high_m, p);
    }
    low_middle_m = glm::min(low_middle_m, middles[order[n]]);
    high_middle_m = glm::max(high_middle_m, middles[order[n]]);
  }
  nodes_[at].low_m = low_m;
  nodes_[at].high_m = high_m;
  const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first);
  if (count <= kLeafTriangles) {
    std::sort(begin, begin + static_cast<std::ptrdiff_t>(count));
    nodes_[at].first = first;
    nodes_[at].count = count;
    return;
  }
  const glm::vec3 size = high_middle_m - low_middle_m;
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half), begin + static_cast<std::ptrdiff_t>(count),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float x = middles[a][axis];
                     const float y = middles[b][axis];
                     return x != y ? x < y : a < b;
                   });
  build(first, half, middles, order);
  nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half, middles, order);
}

DistanceTree::Nearest DistanceTree::nearest(const glm::dvec3& point_m, std::uint32_t hint) const {
  double best2 = distance2_to_triangle(point_m, corners_m(hint));
  std::uint32_t best = hint;
  const auto distance2_to_box = [&](const Node& node) {
    const glm::dvec3 to = glm::max(
        glm::max(glm::dvec3(node.low_m) - point_m, point_m - glm::dvec3(node.high_m)), glm::dvec3(0.0));
    return glm::dot(to, to);
  };
  struct Entry {
    std::uint32_t node;
    double distance2;
  };
  std::array<Entry, 64> stack;  // halving 2^32 triangles takes 32 levels
  std::size_t top = 0;
  stack[top++] = {0, distance2_to_box(nodes_[0])};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance2 >= best2) continue;
    const Node& node = nodes_[entry.node];
    if (node.count > 0) {
      for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
        const double d2 = distance2_to_triangle(point_m, corners_m(n));
        if (d2 < best2) best2 = d2, best = n;
      }
      continue;
    }
    Entry near{entry.node + 1, distance2_to_box(nodes_[entry.node + 1])};
    Entry far{node.first, distance2_to_box(nodes_[node.first])};
    if (far.distance2 < near.distance2) std::swap(near, far);
    if (far.distance2 < best2) stack[top++] = far;
    if (near.distance2 < best2) stack[top++] = near;
  }
  return {std::sqrt(best2), best};
}

}  // namespace objects
