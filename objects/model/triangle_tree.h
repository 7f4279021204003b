// A tree of boxes over the triangles of a mesh, for rays: four boxes or triangles at a time (Wald 2007: binned surface
// area heuristic; Wald, Benthin and Boulos 2008: nodes of several boxes).
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

#include "objects/model/floats4.h"
#include "objects/model/mesh.h"

namespace objects {

// Describes a ray in the model frame. Its origin should be about as far from the model as the model is large: the error of a hit
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

  // Returns a distance from a place within which there is no triangle: that to the nearest box of at most a few triangles,
  // less rounding. Infinity if the tree is empty.
  double clear_distance_m(const glm::dvec3& place_m) const;

  std::size_t bytes() const;
  bool is_empty() const { return nodes_.empty(); }

 private:
  using Lanes = simd::Floats4;
  static constexpr std::uint32_t kWidth = 4;
  // Up to four boxes and what is in them: an inner node, or triangles of blocks_.
  struct Node {
    std::array<Lanes, 3> low_m{};
    std::array<Lanes, 3> high_m{};
    std::array<std::uint32_t, kWidth> first{};
    std::array<std::uint32_t, kWidth> blocks{};  // 0: an inner node
    int used = 0;                                // a bit for each
  };
  // Up to four triangles, corner by corner.
  struct Block {
    std::array<std::array<Lanes, 3>, 3> corner_m{};  // [corner][axis]
    std::array<std::uint32_t, kWidth> triangle{};
    int used = 0;
  };
  // The ray's frame of the intersection test: the axis along which it is longest comes last.
  struct Shear {
    std::size_t x, y, z;
    glm::vec3 origin_m;
    glm::vec3 factor;
  };
  struct Builder;

  static Shear shear_of(const ModelRay& ray);
  // Writes the hits among a block's triangles, and returns a bit for each.
  static int hits_of(const Shear& shear, const Block& block, std::array<TriangleHit, kWidth>& hits);

  std::vector<Node> nodes_;
  std::vector<Block> blocks_;
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
  std::array<Lanes, 3> inverse;
  std::array<Lanes, 3> origin_m;
  for (int k = 0; k < 3; ++k) {
    const float d = ray.direction[k];
    inverse[static_cast<std::size_t>(k)] =
        simd::all(1.0F / (std::abs(d) < kLeast ? std::copysign(kLeast, d) : d));
    origin_m[static_cast<std::size_t>(k)] = simd::all(ray.origin_m[k]);
  }
  struct Entry {
    std::uint32_t node;
    std::uint32_t blocks;
    float t;
  };
  std::array<Entry, 3 * kMostTreeDepth + 1> stack;
  std::size_t top = 0;
  float end = until;
  stack[top++] = {0, 0, 0};
  while (top > 0) {
    const Entry at = stack[--top];
    if (at.t * (1.0F - kBoxTestError) > end) continue;
    if (at.blocks > 0) {
      std::array<TriangleHit, kWidth> hits;
      for (std::uint32_t n = at.node; n < at.node + at.blocks; ++n) {
        const int found = hits_of(shear, blocks_[n], hits);
        for (std::size_t lane = 0; found >> lane != 0; ++lane) {
          const TriangleHit& hit = hits[lane];
          if ((found >> lane & 1) == 0) continue;
          if (!(hit.t < end || (best && hit.t == best->t && hit.triangle < best->triangle))) continue;
          if (!accept(hit)) continue;
          best = hit;
          end = hit.t;
        }
      }
      continue;
    }
    const Node& node = nodes_[at.node];
    Lanes from = simd::all(0);
    Lanes to = simd::all(end);
    for (std::size_t k = 0; k < 3; ++k) {
      const Lanes a = (node.low_m[k] - origin_m[k]) * inverse[k];
      const Lanes b = (node.high_m[k] - origin_m[k]) * inverse[k];
      from = simd::max(from, simd::min(a, b));
      to = simd::min(to, simd::max(a, b) * simd::all(1.0F + kBoxTestError));
    }
    const int entered = simd::bits(from * simd::all(1.0F - kBoxTestError) <= to) & node.used;
    // From the farthest to the nearest, so that the nearest is taken first.
    const std::size_t begin = top;
    for (std::size_t lane = 0; entered >> lane != 0; ++lane) {
      if ((entered >> lane & 1) == 0) continue;
      const Entry child{node.first[lane], node.blocks[lane], from[lane]};
      std::size_t place = top++;
      for (; place > begin && stack[place - 1].t < child.t; --place) stack[place] = stack[place - 1];
      stack[place] = child;
    }
  }
  return best;
}

inline TriangleTree::Shear TriangleTree::shear_of(const ModelRay& ray) {
  Shear s{};
  const glm::vec3 size = glm::abs(ray.direction);
  s.z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  s.x = (s.z + 1) % 3;
  s.y = (s.z + 2) % 3;
  const auto along = [&](std::size_t axis) { return ray.direction[static_cast<int>(axis)]; };
  if (along(s.z) < 0) std::swap(s.x, s.y);  // keeps the winding
  s.factor = {along(s.x) / along(s.z), along(s.y) / along(s.z), 1.0F / along(s.z)};
  s.origin_m = ray.origin_m;
  return s;
}

inline int TriangleTree::hits_of(const Shear& s, const Block& block, std::array<TriangleHit, kWidth>& hits) {
  const auto origin = [&](std::size_t axis) { return simd::all(s.origin_m[static_cast<int>(axis)]); };
  std::array<Lanes, 3> x, y, z;
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes forward = block.corner_m[k][s.z] - origin(s.z);
    z[k] = simd::all(s.factor.z) * forward;
    x[k] = (block.corner_m[k][s.x] - origin(s.x)) - simd::all(s.factor.x) * forward;
    y[k] = (block.corner_m[k][s.y] - origin(s.y)) - simd::all(s.factor.y) * forward;
  }
  Lanes a = x[2] * y[1] - y[2] * x[1];
  Lanes b = x[0] * y[2] - y[0] * x[2];
  Lanes c = x[1] * y[0] - y[1] * x[0];
  const Lanes none = simd::all(0);
  if (const int flat = simd::bits((a == none) | (b == none) | (c == none)) & block.used; flat != 0) {
    // On an edge as far as floats know: products of two floats are exact in double.
    const auto cross = [](float p, float q, float r, float t) {
      return static_cast<float>(static_cast<double>(p) * static_cast<double>(q) -
                                static_cast<double>(r) * static_cast<double>(t));
    };
    for (std::size_t n = 0; n < kWidth; ++n) {
      if ((flat >> n & 1) == 0) continue;
      a[n] = cross(x[2][n], y[1][n], y[2][n], x[1][n]);
      b[n] = cross(x[0][n], y[2][n], y[0][n], x[2][n]);
      c[n] = cross(x[1][n], y[0][n], y[1][n], x[0][n]);
    }
  }
  const Lanes sum = a + b + c;
  const auto some_below = (a < none) | (b < none) | (c < none);
  const auto some_above = (a > none) | (b > none) | (c > none);
  const Lanes t = (a * z[0] + b * z[1] + c * z[2]) / sum;
  const int found = simd::bits(~(some_below & some_above) & (sum != none) & (t >= none)) & block.used;
  for (std::size_t n = 0; found >> n != 0; ++n) {
    if ((found >> n & 1) != 0) hits[n] = {t[n], b[n] / sum[n], c[n] / sum[n], block.triangle[n], sum[n] < 0};
  }
  return found;
}

}  // namespace objects
