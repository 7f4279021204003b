#include "relief/field/chart.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace relief {

namespace {

void require_frame(const glm::dvec3& origin_m, const glm::dvec3& right, const glm::dvec3& up,
                   const Rect& rect) {
  double total = 0;
  for (const glm::dvec3& v : {origin_m, right, up}) total += std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  if (!std::isfinite(total)) throw std::invalid_argument("a chart: not all its numbers are finite");
  constexpr double kTolerance = 1e-9;
  const auto is_unit = [](const glm::dvec3& v) { return std::abs(glm::dot(v, v) - 1) <= kTolerance; };
  if (!is_unit(right) || !is_unit(up) || std::abs(glm::dot(right, up)) > kTolerance)
    throw std::invalid_argument("a chart: its axes right and up must be orthonormal");
  if (!(rect.x0_m < rect.x1_m && rect.y0_m < rect.y1_m))
    throw std::invalid_argument("a chart: its rectangle is empty");
}

Linear along(const glm::dvec3& axis, const glm::dvec3& origin_m) { return {axis, -glm::dot(axis, origin_m)}; }

// a * factor + b * share
Linear mix(const Linear& a, double factor, const Linear& b, double share) {
  return {a.normal * factor + b.normal * share, a.offset * factor + b.offset * share};
}

}  // namespace

Chart Chart::parallel(const glm::dvec3& origin_m, const glm::dvec3& right, const glm::dvec3& up,
                      const Rect& domain) {
  require_frame(origin_m, right, up, domain);
  Chart chart;
  chart.x_ = along(right, origin_m);
  chart.y_ = along(up, origin_m);
  chart.w_ = {{0, 0, 0}, 1};
  chart.rect_ = domain;
  chart.set_sides();
  return chart;
}

Chart Chart::central(const glm::dvec3& centre_m, const glm::dvec3& right, const glm::dvec3& up, double scale_m,
                     const Rect& domain) {
  require_frame(centre_m, right, up, domain);
  if (!(scale_m > 0) || !std::isfinite(scale_m))
    throw std::invalid_argument("a chart: its scale must be positive");
  Chart chart;
  chart.x_ = mix(along(right, centre_m), scale_m, {}, 0);
  chart.y_ = mix(along(up, centre_m), scale_m, {}, 0);
  chart.w_ = along(glm::cross(right, up), centre_m);
  chart.is_parallel_ = false;
  chart.rect_ = domain;
  chart.set_sides();
  return chart;
}

Chart Chart::cube_face(const glm::dvec3& centre_m, mars::Face face, double radius_m) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  return central(centre_m, axes.right, axes.up, radius_m, {-radius_m, -radius_m, radius_m, radius_m});
}

Chart Chart::cut(const Linear& side) const {
  Chart chart = *this;
  chart.cuts_.push_back(side);
  chart.set_sides();
  return chart;
}

void Chart::set_sides() {
  sides_ = cuts_;
  if (!is_parallel_) sides_.push_back(w_);
  if (std::isfinite(rect_.x0_m)) sides_.push_back(mix(x_, 1, w_, -rect_.x0_m));
  if (std::isfinite(rect_.x1_m)) sides_.push_back(mix(x_, -1, w_, rect_.x1_m));
  if (std::isfinite(rect_.y0_m)) sides_.push_back(mix(y_, 1, w_, -rect_.y0_m));
  if (std::isfinite(rect_.y1_m)) sides_.push_back(mix(y_, -1, w_, rect_.y1_m));
}

bool Chart::holds(const glm::dvec3& p_m) const {
  return std::all_of(sides_.begin(), sides_.end(), [&](const Linear& side) { return side.at(p_m) >= 0; }) &&
         (is_parallel_ || w_.at(p_m) > 0);
}

glm::dvec2 Chart::at(const glm::dvec3& p_m) const {
  const glm::dvec2 point{x_.at(p_m), y_.at(p_m)};
  return is_parallel_ ? point : point / w_.at(p_m);
}

std::array<glm::dvec3, 2> Chart::gradients(const glm::dvec3& p_m) const {
  if (is_parallel_) return {x_.normal, y_.normal};
  const double w = w_.at(p_m);
  const glm::dvec2 point = at(p_m);
  return {(x_.normal - point.x * w_.normal) / w, (y_.normal - point.y * w_.normal) / w};
}

Rect Chart::bounds(const glm::dvec3& low_m, const glm::dvec3& high_m) const {
  Rect found{kEndless_m, kEndless_m, -kEndless_m, -kEndless_m};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p{(corner & 1) != 0 ? high_m.x : low_m.x, (corner & 2) != 0 ? high_m.y : low_m.y,
                       (corner & 4) != 0 ? high_m.z : low_m.z};
    // A ratio has its extremes at corners only where its denominator keeps its sign.
    if (!(w_.at(p) > 0)) return rect_;
    const glm::dvec2 point = at(p);
    found = {std::min(found.x0_m, point.x), std::min(found.y0_m, point.y), std::max(found.x1_m, point.x),
             std::max(found.y1_m, point.y)};
  }
  const double slack_m =
      1e-14 * (glm::length(low_m) + glm::length(high_m) + std::abs(x_.offset) + std::abs(y_.offset));
  const double slack = is_parallel_ ? slack_m
                                    : 1e-13 * (std::abs(found.x1_m - found.x0_m) + std::abs(found.x0_m) +
                                               std::abs(found.y1_m - found.y0_m) + std::abs(found.y0_m));
  return {std::max(found.x0_m - slack, rect_.x0_m), std::max(found.y0_m - slack, rect_.y0_m),
          std::min(found.x1_m + slack, rect_.x1_m), std::min(found.y1_m + slack, rect_.y1_m)};
}

}  // namespace relief
