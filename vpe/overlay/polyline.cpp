#include "vpe/overlay/polyline.h"

#include <glm/geometric.hpp>

namespace vpe::overlay {

namespace {

double cross_product(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }
glm::dvec2 left_of(glm::dvec2 a) { return {-a.y, a.x}; }

}  // namespace

std::vector<glm::dvec2> simplified(std::span<const glm::dvec2> points, double tolerance_px) {
  std::vector<glm::dvec2> out;
  if (points.empty()) return out;
  out.push_back(points[0]);
  // Directions from the last kept point that pass all points since within the tolerance lie between these two.
  glm::dvec2 rightmost{0, 0}, leftmost{0, 0};
  double farthest_px = 0;
  bool is_open = false;  // some point has narrowed the directions
  for (std::size_t n = 1; n < points.size(); ++n) {
    glm::dvec2 along = points[n] - out.back();
    double length_px = glm::length(along);
    const bool passes =
        length_px >= farthest_px &&
        (!is_open || (cross_product(rightmost, along) >= 0 && cross_product(along, leftmost) >= 0));
    if (!passes) {
      out.push_back(points[n - 1]);
      along = points[n] - out.back();
      length_px = glm::length(along);
      is_open = false;
    }
    farthest_px = length_px;
    // A point so near is within the tolerance of any piece from here.
    if (length_px <= tolerance_px) continue;
    const glm::dvec2 aside = left_of(along) * (tolerance_px / length_px);
    const glm::dvec2 right = along - aside, left = along + aside;
    if (!is_open || cross_product(rightmost, right) > 0) rightmost = right;
    if (!is_open || cross_product(left, leftmost) > 0) leftmost = left;
    is_open = true;
  }
  if (points.size() > 1) out.push_back(points.back());
  return out;
}

}  // namespace vpe::overlay
