#include "objects/model/triangle_tree.h"

#include <algorithm>

namespace objects {

namespace {

constexpr std::size_t kBins = 16;
constexpr std::uint32_t kMostTrianglesOfLeaf = 4;
// Costs of a step to a child and of a triangle's test.
constexpr float kStepCost = 1.0F;
constexpr float kTriangleCost = 1.2F;
// Beyond this depth nodes are halved by count, which ends within 32 more levels.
constexpr int kDepthOfHalving = 56;

struct Box {
  glm::vec3 low_m{std::numeric_limits<float>::infinity()};
  glm::vec3 high_m{-std::numeric_limits<float>::infinity()};
  void add(const glm::vec3& p) {
    low_m = glm::min(low_m, p);
    high_m = glm::max(high_m, p);
  }
  void add(const Box& other) {
    low_m = glm::min(low_m, other.low_m);
    high_m = glm::max(high_m, other.high_m);
  }
  float area() const {
    const glm::vec3 d = high_m - low_m;
    return d.x >= 0 ? d.x * d.y + d.y * d.z + d.z * d.x : 0.0F;
  }
};

struct BoxedTriangle {
  Box box;
  glm::vec3 middle_m;
  std::uint32_t triangle;
};

std::size_t bin_of(float value, float low, float per_unit) {
  return std::min(kBins - 1, static_cast<std::size_t>(std::max(0.0F, (value - low) * per_unit)));
}

}  // namespace

struct TriangleTree::Builder {
  const Mesh& mesh;
  TriangleTree& tree;
  std::vector<BoxedTriangle> items;

  struct Split {
    int axis = -1;  // none: a leaf costs less
    std::size_t bin = 0;
    float low = 0;
    float per_unit = 0;
  };

  Split best_split(std::size_t begin, std::size_t end, const Box& box) const {
    Box middles;
    for (std::size_t n = begin; n < end; ++n) middles.add(items[n].middle_m);
    Split best;
    const auto count = static_cast<float>(end - begin);
    float least =
        end - begin <= kMostTrianglesOfLeaf ? kTriangleCost * count : std::numeric_limits<float>::infinity();
    const float whole = std::max(box.area(), std::numeric_limits<float>::min());
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = middles.high_m[axis] - middles.low_m[axis];
      if (!(extent > 0)) continue;
      const float per_unit = static_cast<float>(kBins) / extent;
      if (!std::isfinite(per_unit)) continue;
      std::array<Box, kBins> boxes;
      std::array<std::size_t, kBins> counts{};
      for (std::size_t n = begin; n < end; ++n) {
        const std::size_t bin = bin_of(items[n].middle_m[axis], middles.low_m[axis], per_unit);
        boxes[bin].add(items[n].box);
        ++counts[bin];
      }
      std::array<float, kBins> right_cost{};
      Box right;
      std::size_t right_count = 0;
      for (std::size_t bin = kBins - 1; bin > 0; --bin) {
        right.add(boxes[bin]);
        right_count += counts[bin];
        right_cost[bin] = right.area() * static_cast<float>(right_count);
      }
      Box left;
      std::size_t left_count = 0;
      for (std::size_t bin = 1; bin < kBins; ++bin) {
        left.add(boxes[bin - 1]);
        left_count += counts[bin - 1];
        if (left_count == 0 || left_count == end - begin) continue;
        const float cost = kStepCost + kTriangleCost *
                                           (left.area() * static_cast<float>(left_count) + right_cost[bin]) /
                                           whole;
        if (cost < least) {
          least = cost;
          best = {axis, bin, middles.low_m[axis], per_unit};
        }
      }
    }
    return best;
  }

  // Returns where the second half begins, or `begin` for a leaf.
  std::size_t divide(std::size_t begin, std::size_t end, const Box& box, int depth) {
    const auto first = items.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = items.begin() + static_cast<std::ptrdiff_t>(end);
    if (depth < kDepthOfHalving) {
      const Split split = best_split(begin, end, box);
      if (split.axis >= 0) {
        const auto middle = std::stable_partition(first, last, [&](const BoxedTriangle& t) {
          return bin_of(t.middle_m[split.axis], split.low, split.per_unit) < split.bin;
        });
        return static_cast<std::size_t>(middle - items.begin());
      }
    }
    return end - begin <= kMostTrianglesOfLeaf ? begin : begin + (end - begin) / 2;
  }

  void build(std::size_t begin, std::size_t end, int depth) {
    Box box;
    for (std::size_t n = begin; n < end; ++n) box.add(items[n].box);
    const std::size_t at = tree.nodes_.size();
    tree.nodes_.push_back({box.low_m, 0, box.high_m, 0});
    const std::size_t middle = divide(begin, end, box, depth);
    if (middle == begin) {
      tree.nodes_[at].first = static_cast<std::uint32_t>(tree.corners_.size());
      tree.nodes_[at].count = static_cast<std::uint32_t>(end - begin);
      for (std::size_t n = begin; n < end; ++n) {
        const glm::uvec3 t = mesh.triangles[items[n].triangle];
        tree.corners_.push_back(
            {{mesh.positions_m[t.x], mesh.positions_m[t.y], mesh.positions_m[t.z]}, items[n].triangle});
      }
      return;
    }
    build(begin, middle, depth + 1);
    tree.nodes_[at].first = static_cast<std::uint32_t>(tree.nodes_.size());
    build(middle, end, depth + 1);
  }
};

TriangleTree::TriangleTree(const Mesh& mesh) {
  Builder builder{mesh, *this, {}};
  builder.items.reserve(mesh.triangles.size());
  for (std::uint32_t n = 0; n < mesh.triangles.size(); ++n) {
    BoxedTriangle item;
    item.triangle = n;
    for (int k = 0; k < 3; ++k) item.box.add(mesh.positions_m[mesh.triangles[n][k]]);
    item.middle_m = 0.5F * (item.box.low_m + item.box.high_m);
    builder.items.push_back(item);
  }
  corners_.reserve(mesh.triangles.size());
  if (!builder.items.empty()) builder.build(0, builder.items.size(), 0);
  nodes_.shrink_to_fit();
}

std::size_t TriangleTree::bytes() const {
  return nodes_.capacity() * sizeof(Node) + corners_.capacity() * sizeof(Corners);
}

}  // namespace objects
