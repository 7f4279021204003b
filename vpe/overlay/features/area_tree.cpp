#include "vpe/overlay/features/area_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace vpe::overlay {
namespace {

constexpr std::uint32_t kLeavesOfNode = 4;

bool holds(const AreaTree::Extent& extent, glm::dvec2 low, glm::dvec2 high) {
  return extent.low_deg.x <= high.x && extent.low_deg.y <= high.y && extent.high_deg.x >= low.x &&
         extent.high_deg.y >= low.y;
}

}  // namespace

AreaTree::AreaTree(std::span<const Extent> extents) {
  for (std::uint32_t n = 0; n < extents.size(); ++n) {
    Extent own = extents[n];
    const double width = own.high_deg.x - own.low_deg.x;
    if (!(width < 360)) {
      own.low_deg.x = -180 - AreaTree::kLargestPad_deg;
      own.high_deg.x = 180 + AreaTree::kLargestPad_deg;
      leaves_.push_back({own, n});
      continue;
    }
    // Each turn that comes near [-180, 180].
    const double west = std::remainder(own.low_deg.x, 360.0);
    for (const double turn : {-360.0, 0.0, 360.0}) {
      own.low_deg.x = west + turn;
      own.high_deg.x = west + turn + width;
      if (own.high_deg.x >= -180 - AreaTree::kLargestPad_deg &&
          own.low_deg.x <= 180 + AreaTree::kLargestPad_deg)
        leaves_.push_back({own, n});
    }
  }
  if (!leaves_.empty()) build(0, static_cast<std::uint32_t>(leaves_.size()));
}

void AreaTree::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t own = nodes_.size();
  Node node{leaves_[begin].extent, begin, end, 0};
  for (std::uint32_t n = begin; n < end; ++n) {
    node.extent.low_deg = glm::min(node.extent.low_deg, leaves_[n].extent.low_deg);
    node.extent.high_deg = glm::max(node.extent.high_deg, leaves_[n].extent.high_deg);
  }
  nodes_.push_back(node);
  if (end - begin <= kLeavesOfNode) return;
  const glm::dvec2 size = node.extent.high_deg - node.extent.low_deg;
  const int axis = size.x >= size.y ? 0 : 1;
  const auto middle = [axis](const Leaf& leaf) {
    return leaf.extent.low_deg[axis] + leaf.extent.high_deg[axis];
  };
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(leaves_.begin() + begin, leaves_.begin() + half, leaves_.begin() + end,
                   [&](const Leaf& a, const Leaf& b) {
                     return middle(a) != middle(b) ? middle(a) < middle(b) : a.number < b.number;
                   });
  build(begin, half);
  nodes_[own].right = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

void AreaTree::find(glm::dvec2 place_deg, double pad_deg, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (nodes_.empty()) return;
  const glm::dvec2 place(std::remainder(place_deg.x, 360.0), place_deg.y);
  const glm::dvec2 low = place - pad_deg;
  const glm::dvec2 high = place + pad_deg;
  constexpr std::size_t kDeepest = 64;
  std::uint32_t open[kDeepest];
  std::size_t count = 0;
  open[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = open[--count];
    const Node& node = nodes_[at];
    if (!holds(node.extent, low, high)) continue;
    if (node.right != 0) {
      open[count++] = node.right;
      open[count++] = at + 1;
      continue;
    }
    for (std::uint32_t n = node.begin; n < node.end; ++n)
      if (holds(leaves_[n].extent, low, high)) found.push_back(leaves_[n].number);
  }
  if (found.size() < 2) return;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace vpe::overlay
