#include "relief/cap_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "mars/geodesy/sphere.h"

namespace relief {

namespace {

constexpr std::uint32_t kLeafCaps = 4;

// Returns the longest straight distance from the centre of a cap to its points.
double chord_of(const mars::Cap& cap) {
  return 2 * std::sin(std::clamp(cap.radius_rad, 0.0, mars::kPi) / 2) + 1e-14;
}

}  // namespace

CapTree::CapTree(std::span<const mars::Cap> caps) {
  if (caps.empty()) return;
  for (const mars::Cap& cap : caps) {
    const double chord = chord_of(cap);
    boxes_.push_back({cap.centre - chord, cap.centre + chord});
  }
  order_.resize(caps.size());
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, static_cast<std::uint32_t>(caps.size()));
}

std::uint32_t CapTree::build(std::uint32_t first, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.box = boxes_[order_[first]];
  Box middles{glm::dvec3(4), glm::dvec3(-4)};  // twice the centres lie within
  for (std::uint32_t n = first; n < end; ++n) {
    const Box& box = boxes_[order_[n]];
    node.box = {glm::min(node.box.low, box.low), glm::max(node.box.high, box.high)};
    middles = {glm::min(middles.low, box.low + box.high), glm::max(middles.high, box.low + box.high)};
  }
  nodes_.push_back(node);
  if (end - first <= kLeafCaps) {
    nodes_[number].first = first;
    nodes_[number].count = end - first;
    return number;
  }
  const glm::dvec3 extent = middles.high - middles.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = first + (end - first) / 2;
  const auto at = [this](std::uint32_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
  // Equal centres are ordered by number, so that caps stacked at one place are found in order.
  std::nth_element(at(first), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const double middle_a = boxes_[a].low[axis] + boxes_[a].high[axis];
    const double middle_b = boxes_[b].low[axis] + boxes_[b].high[axis];
    return middle_a != middle_b ? middle_a < middle_b : a < b;
  });
  const std::uint32_t left = build(first, half);
  const std::uint32_t right = build(half, end);
  nodes_[number].first = left;
  nodes_[number].second = right;
  return number;
}

void CapTree::find(const mars::Cap& cap, std::vector<std::uint32_t>& found) const {
  found.clear();
  if (nodes_.empty()) return;
  const double chord = chord_of(cap);
  const auto is_near = [&](const Box& box) {
    const glm::dvec3 away = cap.centre - glm::clamp(cap.centre, box.low, box.high);
    return glm::dot(away, away) <= chord * chord;
  };
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (!is_near(node.box)) continue;
    if (node.count == 0) {
      open.push_back(node.second);
      open.push_back(node.first);
      continue;
    }
    for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
      if (is_near(boxes_[order_[n]])) found.push_back(order_[n]);
    }
  }
  if (!std::is_sorted(found.begin(), found.end())) std::sort(found.begin(), found.end());
}

}  // namespace relief
