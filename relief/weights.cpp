#include "relief/weights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "relief/interval_math.h"

namespace relief {

namespace {

// Widens bounds of a weight by rounding. 0 and 1 stay: a weight has them exactly where it is constant.
Interval weight_bounds(double low, double high) {
  return {low >= 1 ? 1.0 : std::max(0.0, low - kRounding), high <= 0 ? 0.0 : std::min(1.0, high + kRounding)};
}

}  // namespace

Rect CircleWeight::support() const { return centred_rect(radius_m_ + falloff_m_, radius_m_ + falloff_m_); }

double CircleWeight::at(double r_m) const { return smooth_step(1 - (r_m - radius_m_) / falloff_m_); }

double CircleWeight::height_m(double x_m, double y_m) const { return at(radius_of(x_m, y_m)); }

glm::dvec2 CircleWeight::gradient(double x_m, double y_m) const {
  const double r_m = radius_of(x_m, y_m);
  if (!(r_m > radius_m_)) return {0, 0};
  const double slope = -smooth_step_slope((r_m - radius_m_) / falloff_m_) / falloff_m_;
  return glm::dvec2(x_m, y_m) * (slope / r_m);
}

Interval CircleWeight::bounds_m(const Rect& rect) const {
  const Interval r_m = radii_of(rect);
  return weight_bounds(at(r_m.high), at(r_m.low));
}

Rect BoxWeight::support() const { return grown(box_, falloff_m_); }

double BoxWeight::at(double distance_m) const { return smooth_step(1 - distance_m / falloff_m_); }

double BoxWeight::height_m(double x_m, double y_m) const { return at(distance_of(box_, x_m, y_m)); }

glm::dvec2 BoxWeight::gradient(double x_m, double y_m) const {
  const double distance_m = distance_of(box_, x_m, y_m);
  if (!(distance_m > 0)) return {0, 0};
  const double slope = -smooth_step_slope(distance_m / falloff_m_) / falloff_m_;
  return (glm::dvec2(x_m, y_m) - nearest_of(box_, x_m, y_m)) * (slope / distance_m);
}

Interval BoxWeight::bounds_m(const Rect& rect) const {
  const Interval distance_m = distances_of(box_, rect);
  return weight_bounds(at(distance_m.high), at(distance_m.low));
}

PolygonWeight::PolygonWeight(std::vector<glm::dvec2> corners_m, double falloff_m)
    : corners_m_(std::move(corners_m)), falloff_m_(falloff_m) {
  support_ = {corners_m_[0].x, corners_m_[0].y, corners_m_[0].x, corners_m_[0].y};
  for (const glm::dvec2& corner : corners_m_) {
    support_.x0_m = std::min(support_.x0_m, corner.x);
    support_.y0_m = std::min(support_.y0_m, corner.y);
    support_.x1_m = std::max(support_.x1_m, corner.x);
    support_.y1_m = std::max(support_.y1_m, corner.y);
  }
}

PolygonWeight::Border PolygonWeight::border(double x_m, double y_m) const {
  const glm::dvec2 point(x_m, y_m);
  bool is_inside = false;
  Border found{std::numeric_limits<double>::infinity(), point};
  for (std::size_t n = 0; n < corners_m_.size(); ++n) {
    const glm::dvec2& a = corners_m_[n];
    const glm::dvec2& b = corners_m_[n + 1 == corners_m_.size() ? 0 : n + 1];
    if ((a.y > y_m) != (b.y > y_m) && x_m < a.x + (b.x - a.x) * ((y_m - a.y) / (b.y - a.y)))
      is_inside = !is_inside;
    const glm::dvec2 edge = b - a;
    const double length2 = glm::dot(edge, edge);
    const double share = length2 > 0 ? std::clamp(glm::dot(point - a, edge) / length2, 0.0, 1.0) : 0.0;
    const glm::dvec2 nearest_m = a + edge * share;
    const double distance_m = glm::length(point - nearest_m);
    if (distance_m < found.distance_m) found = {distance_m, nearest_m};
  }
  if (!is_inside) found.distance_m = -found.distance_m;
  return found;
}

double PolygonWeight::height_m(double x_m, double y_m) const {
  if (!contains(support_, x_m, y_m)) return 0;
  return smooth_step(border(x_m, y_m).distance_m / falloff_m_);
}

glm::dvec2 PolygonWeight::gradient(double x_m, double y_m) const {
  if (!contains(support_, x_m, y_m)) return {0, 0};
  const Border at = border(x_m, y_m);
  if (!(at.distance_m > 0)) return {0, 0};
  const double slope = smooth_step_slope(at.distance_m / falloff_m_) / falloff_m_;
  return (glm::dvec2(x_m, y_m) - at.nearest_m) * (slope / at.distance_m);
}

Interval PolygonWeight::bounds_m(const Rect& rect) const {
  if (!overlap(rect, support_)) return {0, 0};
  const Rect inner = intersection(rect, support_);
  const double half_x_m = (inner.x1_m - inner.x0_m) / 2;
  const double half_y_m = (inner.y1_m - inner.y0_m) / 2;
  const double extent_m = (support_.x1_m - support_.x0_m) + (support_.y1_m - support_.y0_m);
  const double way_m = radius_of(half_x_m, half_y_m) + kRounding * extent_m;
  const double distance_m = border(inner.x0_m + half_x_m, inner.y0_m + half_y_m).distance_m;
  const Interval inside = weight_bounds(smooth_step((distance_m - way_m) / falloff_m_),
                                        smooth_step((distance_m + way_m) / falloff_m_));
  return contains(support_, rect) ? inside : Interval{0, inside.high};
}

}  // namespace relief
