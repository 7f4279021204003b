// A tree of boxes over the triangles of a mesh, for rays (Wald 2007: binned surface area heuristic).
//
// Typical usage:
//   const TriangleTree tree(mesh);
//   const std::optional<TriangleHit> hit = tree.nearest(ray, infinity, [](const TriangleHit&) { return true; });
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

// A ray in the model frame. Its origin should be about as far from the model as the model is large: the error of a hit
// is in proportion to both.
struct ModelRay {
  glm::vec3 origin_m;
  glm::vec3 direction;  // of any length but 0; t counts in it
};

struct TriangleHit {
  float t = 0;
  float u = 0;  // weights of the second and third corner
  float v = 0;
  std::uint32_t triangle = 0;
  bool is_back = false;  // the corners run clockwise seen from the origin
};

// Immutable after it is built. Any thread may call any member.
class TriangleTree {
 public:
  TriangleTree() = default;
  // The mesh must pass check(). The tree is the same on every machine.
  explicit TriangleTree(const Mesh& mesh);

  // Returns the nearest hit with t in [0, until) that accept(hit) accepts, or nullopt. Between hits at the same t that
  // of the lower triangle number wins. Watertight: a ray that passes between two triangles of a shared edge hits one of
  // them (Woop, Benthin and Wald 2013). Accepted hits shorten the search; accept() sees each hit before the nearest one
  // found so far once, in no stated order.
  template <class Accept>
  std::optional<TriangleHit> nearest(const ModelRay& ray, float until, const Accept& accept) const;

  std::size_t bytes() const;
  bool is_empty() const { return nodes_.empty(); }

 private:
  // A node with count 0 is inner: its second child is `first`, its first child follows it.
  struct Node {
    glm::vec3 low_m;
    std::uint32_t first = 0;
    glm::vec3 high_m;
    std::uint32_t count = 0;
  };
  struct Corners {
    std::array<glm::vec3, 3> at_m;
    std::uint32_t triangle;
  };
  // The ray's frame of the intersection test: the axis along which it is longest comes last.
  struct Shear {
    int x, y, z;
    glm::vec3 origin_m;
    glm::vec3 factor;
  };
  struct Builder;

  static Shear shear_of(const ModelRay& ray);
  static std::optional<TriangleHit> hit(const Shear& shear, const Corners& corners);

  std::vector<Node> nodes_;
  std::vector<Corners> corners_;
};

// Half-width of the interval in which the rounding of a box test's t lies, relative to t.
inline constexpr float kBoxTestError = 4.0F * std::numeric_limits<float>::epsilon();
inline constexpr int kMostTreeDepth = 96;

template <class Accept>
std::optional<TriangleHit> TriangleTree::nearest(const ModelRay& ray, float until, const Accept& accept) const {
  std::optional<TriangleHit> best;
  if (nodes_.empty()) return best;
  const Shear shear = shear_of(ray);
  // No component is 0, so that no product below is NaN.
  constexpr float kLeast = 1e-30F;
  glm::vec3 inverse;
  for (int k = 0; k < 3; ++k)
    inverse[k] = 1.0F / (std::abs(ray.direction[k]) < kLeast ? std::copysign(kLeast, ray.direction[k])
                                                             : ray.direction[k]);
  // Returns where the ray enters a box, or infinity if it misses it.
  const auto enter = [&](const Node& node, float end) {
    float from = 0;
    float to = end;
    for (int k = 0; k < 3; ++k) {
      const float a = (node.low_m[k] - ray.origin_m[k]) * inverse[k];
      const float b = (node.high_m[k] - ray.origin_m[k]) * inverse[k];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b) * (1.0F + kBoxTestError));
    }
    return from * (1.0F - kBoxTestError) <= to ? from : std::numeric_limits<float>::infinity();
  };
  struct Entry {
    std::uint32_t node;
    float t;
  };
  std::array<Entry, kMostTreeDepth> stack;
  int top = 0;
  float end = until;
  if (const float t = enter(nodes_[0], end); t != std::numeric_limits<float>::infinity())
    stack[0] = {0, t}, top = 1;
  while (top > 0) {
    const Entry at = stack[static_cast<std::size_t>(--top)];
    if (at.t * (1.0F - kBoxTestError) > end) continue;
    const Node& node = nodes_[at.node];
    if (node.count > 0) {
      for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
        const std::optional<TriangleHit> found = hit(shear, corners_[n]);
        if (!found || !(found->t < end || (best && found->t == best->t && found->triangle < best->triangle)))
          continue;
        if (!accept(*found)) continue;
        best = found;
        end = found->t;
      }
      continue;
    }
    const std::uint32_t left = at.node + 1;
    const std::uint32_t right = node.first;
    const float tl = enter(nodes_[left], end);
    const float tr = enter(nodes_[right], end);
    const bool right_first = tr < tl;
    const Entry near{right_first ? right : left, right_first ? tr : tl};
    const Entry far{right_first ? left : right, right_first ? tl : tr};
    if (far.t != std::numeric_limits<float>::infinity()) stack[static_cast<std::size_t>(top++)] = far;
    if (near.t != std::numeric_limits<float>::infinity()) stack[static_cast<std::size_t>(top++)] = near;
  }
  return best;
}

inline TriangleTree::Shear TriangleTree::shear_of(const ModelRay& ray) {
  Shear s{};
  const glm::vec3 size = glm::abs(ray.direction);
  s.z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  s.x = (s.z + 1) % 3;
  s.y = (s.z + 2) % 3;
  if (ray.direction[s.z] < 0) std::swap(s.x, s.y);  // keeps the winding
  s.factor = {ray.direction[s.x] / ray.direction[s.z], ray.direction[s.y] / ray.direction[s.z],
              1.0F / ray.direction[s.z]};
  s.origin_m = ray.origin_m;
  return s;
}

inline std::optional<TriangleHit> TriangleTree::hit(const Shear& s, const Corners& corners) {
  glm::vec3 x, y, z;
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 p = corners.at_m[static_cast<std::size_t>(k)] - s.origin_m;
    z[k] = s.factor.z * p[s.z];
    x[k] = p[s.x] - s.factor.x * p[s.z];
    y[k] = p[s.y] - s.factor.y * p[s.z];
  }
  float a = x[2] * y[1] - y[2] * x[1];
  float b = x[0] * y[2] - y[0] * x[2];
  float c = x[1] * y[0] - y[1] * x[0];
  if (a == 0.0F || b == 0.0F || c == 0.0F) {
    // On an edge as far as floats know: products of two floats are exact in double.
    const auto cross = [](float p, float q, float r, float t) {
      return static_cast<float>(static_cast<double>(p) * q - static_cast<double>(r) * t);
    };
    a = cross(x[2], y[1], y[2], x[1]);
    b = cross(x[0], y[2], y[0], x[2]);
    c = cross(x[1], y[0], y[1], x[0]);
  }
  if ((a < 0 || b < 0 || c < 0) && (a > 0 || b > 0 || c > 0)) return std::nullopt;
  const float sum = a + b + c;
  if (sum == 0.0F) return std::nullopt;
  const float t = (a * z[0] + b * z[1] + c * z[2]) / sum;
  if (!(t >= 0)) return std::nullopt;
  return TriangleHit{t, b / sum, c / sum, corners.triangle, sum < 0};
}

}  // namespace objects
