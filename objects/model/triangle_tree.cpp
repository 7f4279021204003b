#include "objects/model/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  // A node of the tree of two children, from which the one of four is made. `count` 0: inner.
  struct Pair {
    Box box;
    std::uint32_t first = 0;  // item, or the second child; the first one follows its parent
    std::uint32_t count = 0;
  };

  const Mesh& mesh;
  TriangleTree& tree;
  std::vector<BoxedTriangle> items;
  std::vector<Pair> pairs;

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
    const std::size_t at = pairs.size();
    pairs.push_back({box, 0, 0});
    const std::size_t middle = divide(begin, end, box, depth);
    if (middle == begin) {
      pairs[at].first = static_cast<std::uint32_t>(begin);
      pairs[at].count = static_cast<std::uint32_t>(end - begin);
      return;
    }
    build(begin, middle, depth + 1);
    pairs[at].first = static_cast<std::uint32_t>(pairs.size());
    build(middle, end, depth + 1);
  }

  // Returns the first of the blocks that hold a leaf's triangles.
  std::uint32_t add_blocks(const Pair& leaf) {
    const auto first = static_cast<std::uint32_t>(tree.blocks_.size());
    for (std::uint32_t n = 0; n < leaf.count; ++n) {
      const std::uint32_t lane = n % kWidth;
      if (lane == 0) tree.blocks_.emplace_back();
      Block& block = tree.blocks_.back();
      const std::uint32_t triangle = items[leaf.first + n].triangle;
      block.used |= 1 << lane;
      block.triangle[lane] = triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3& p = mesh.positions_m[mesh.triangles[triangle][static_cast<int>(k)]];
        for (std::size_t axis = 0; axis < 3; ++axis) block.corner_m[k][axis][lane] = p[static_cast<int>(axis)];
      }
    }
    return first;
  }

  // Adds the node whose children are the up to four largest boxes below a pair. Returns its number.
  std::uint32_t collapse(std::uint32_t pair) {
    std::vector<std::uint32_t> children{pair};
    while (children.size() < kWidth) {
      std::size_t largest = children.size();
      for (std::size_t n = 0; n < children.size(); ++n) {
        if (pairs[children[n]].count > 0) continue;
        if (largest == children.size() || pairs[children[n]].box.area() > pairs[children[largest]].box.area())
          largest = n;
      }
      if (largest == children.size()) break;
      const std::uint32_t opened = children[largest];
      children[largest] = opened + 1;
      children.push_back(pairs[opened].first);
    }
    const auto at = static_cast<std::uint32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    for (std::size_t lane = 0; lane < children.size(); ++lane) {
      const Pair& child = pairs[children[lane]];
      const std::uint32_t blocks = (child.count + kWidth - 1) / kWidth;
      const std::uint32_t first = blocks > 0 ? add_blocks(child) : collapse(children[lane]);
      Node& node = tree.nodes_[at];
      node.used |= 1 << lane;
      node.first[lane] = first;
      node.blocks[lane] = blocks;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low_m[axis][lane] = child.box.low_m[static_cast<int>(axis)];
        node.high_m[axis][lane] = child.box.high_m[static_cast<int>(axis)];
      }
    }
    return at;
  }
};

TriangleTree::TriangleTree(const Mesh& mesh) {
  Builder builder{mesh, *this, {}, {}};
  builder.items.reserve(mesh.triangles.size());
  for (std::uint32_t n = 0; n < mesh.triangles.size(); ++n) {
    BoxedTriangle item;
    item.triangle = n;
    for (int k = 0; k < 3; ++k) item.box.add(mesh.positions_m[mesh.triangles[n][k]]);
    item.middle_m = 0.5F * (item.box.low_m + item.box.high_m);
    builder.items.push_back(item);
  }
  if (builder.items.empty()) return;
  builder.build(0, builder.items.size(), 0);
  (void)builder.collapse(0);
  nodes_.shrink_to_fit();
  blocks_.shrink_to_fit();
}

double TriangleTree::clear_distance_m(const glm::dvec3& place_m) const {
  if (nodes_.empty()) return std::numeric_limits<double>::infinity();
  constexpr double kRounding = 1e-5;
  double clear_m = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::uint32_t>> open{{0.0, 0}};  // of inner nodes
  while (!open.empty()) {
    const auto [least_m, number] = open.back();
    open.pop_back();
    if (least_m >= clear_m) continue;
    const Node& node = nodes_[number];
    for (std::size_t lane = 0; node.used >> lane != 0; ++lane) {
      if ((node.used >> lane & 1) == 0) continue;
      double squared_m2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double at = place_m[static_cast<glm::length_t>(k)];
        const double outside = std::max({node.low_m[k][lane] - at, at - node.high_m[k][lane], 0.0});
        squared_m2 += outside * outside;
      }
      const double away_m = std::sqrt(squared_m2) * (1 - kRounding);
      if (away_m >= clear_m) continue;
      if (node.blocks[lane] > 0) {
        clear_m = away_m;
      } else {
        open.emplace_back(away_m, node.first[lane]);
      }
    }
  }
  return clear_m;
}

std::size_t TriangleTree::bytes() const {
  return nodes_.capacity() * sizeof(Node) + blocks_.capacity() * sizeof(Block);
}

}  // namespace objects
