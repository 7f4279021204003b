// A smooth curve through unit vectors at given times: positions on the sphere (dvec3), attitudes as quaternions
// (dvec4).
//
// Typical usage:
//   const SphericalSpline<glm::dvec3> ground_track(times_s, directions);
//   const glm::dvec3 direction = ground_track.at(12.5);
//
// Between two knots the curve is a cubic Bezier whose linear steps are great-circle steps (de Casteljau by
// slerp, Shoemake 1985). Its velocity at a knot is the non-uniform Catmull-Rom one, limited to twice the speed
// of the slower of the two adjacent segments, so that the curve does not overshoot: within a segment it is
// never farther from the segment's start than 1.22 of the segment, and never faster than 2.5 of its mean speed
// (control points -2/3 and 5/3 of the way give max 2 u + u^2 - 2 u^3 = 1.2198 and 2.5; on the sphere a great
// circle is the worst case). For that, the inner control points of a segment longer than 1 rad are kept within
// 1 rad of those of its great circle; else great-circle steps between them could lead round the other side.
// The velocity is zero beside a segment that does not move: a hold stays still, and motion into and out of it
// is smooth. At both ends it is the segment's own velocity. Therefore:
//   - the curve and its velocity are continuous;
//   - two knots give the great circle at constant speed;
//   - knots on one great circle give a curve that stays on it;
//   - rotating all knots rotates the curve.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

namespace scripts {

// Returns the tangent at unit p towards unit q along the shorter great circle; its length is the angle between
// them. Zero for equal and for opposite points.
template <class Vec>
Vec tangent_towards(const Vec& p, const Vec& q) {
  const Vec chord = q - p;
  const Vec across = chord - p * glm::dot(p, chord);
  const double size = glm::length(across);
  if (size == 0.0) return Vec(0.0);
  // Half-angle form: accurate for close and for nearly opposite points alike.
  const double angle_rad = 2.0 * std::atan2(glm::length(chord), glm::length(p + q));
  return across * (angle_rad / size);
}

// Returns the unit vector reached from unit p along a tangent at p whose length is the angle.
template <class Vec>
Vec follow(const Vec& p, const Vec& tangent) {
  const double angle_rad = glm::length(tangent);
  if (angle_rad == 0.0) return p;
  return glm::normalize(p * std::cos(angle_rad) + tangent * (std::sin(angle_rad) / angle_rad));
}

// Holds the curve. Immutable; any thread may call at().
template <class Vec>
class SphericalSpline {
 public:
  // Requires as many times (strictly ascending) as unit points, at least one. Successive points must not be
  // opposite.
  SphericalSpline(std::vector<double> times_s, std::vector<Vec> points)
      : times_s_(std::move(times_s)), points_(std::move(points)), velocities_(points_.size(), Vec(0.0)) {
    const std::size_t last = points_.size() - 1;
    if (last == 0) return;
    velocities_[0] = tangent_towards(points_[0], points_[1]) / (times_s_[1] - times_s_[0]);
    velocities_[last] =
        -tangent_towards(points_[last], points_[last - 1]) / (times_s_[last] - times_s_[last - 1]);
    for (std::size_t i = 1; i < last; ++i) velocities_[i] = inner_velocity(i);
  }

  // Returns the unit vector at a time; the first or last point outside the times. Exact at the knots.
  Vec at(double time_s) const {
    if (!(time_s > times_s_.front())) return points_.front();
    if (time_s >= times_s_.back()) return points_.back();
    const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
    const auto i = static_cast<std::size_t>(after - times_s_.begin()) - 1;
    const double span_s = times_s_[i + 1] - times_s_[i];
    const double u = (time_s - times_s_[i]) / span_s;
    if (u == 0.0 || points_[i] == points_[i + 1]) return points_[i];
    const Vec b0 = points_[i];
    const Vec b1 = follow(b0, velocities_[i] * (span_s / 3.0));
    const Vec b3 = points_[i + 1];
    const Vec b2 = follow(b3, -velocities_[i + 1] * (span_s / 3.0));
    const Vec middle = step(b1, b2, u);
    return step(step(step(b0, b1, u), middle, u), step(middle, step(b2, b3, u), u), u);
  }

 private:
  static constexpr double kFarthestControl_rad = 1.0;

  static Vec step(const Vec& p, const Vec& q, double u) { return follow(p, tangent_towards(p, q) * u); }

  Vec inner_velocity(std::size_t i) const {
    const double before_s = times_s_[i] - times_s_[i - 1];
    const double after_s = times_s_[i + 1] - times_s_[i];
    const Vec before = -tangent_towards(points_[i], points_[i - 1]) / before_s;
    const Vec after = tangent_towards(points_[i], points_[i + 1]) / after_s;
    const Vec velocity = (before * after_s + after * before_s) / (before_s + after_s);
    const double limit = 2.0 * std::min(glm::length(before), glm::length(after));
    const double speed = glm::length(velocity);
    const Vec limited = speed > limit ? velocity * (limit / speed) : velocity;
    const double share = std::min(share_near(limited, before, before_s), share_near(limited, after, after_s));
    return share < 1.0 ? limited * share : limited;
  }

  // Returns the largest share of a velocity, at most 1, whose control point lies within kFarthestControl_rad of
  // that of the great circle, `straight` radians a second over `span_s`.
  static double share_near(const Vec& velocity, const Vec& straight, double span_s) {
    const double reach = std::max(3.0 * kFarthestControl_rad / span_s, glm::length(straight));
    const double a = glm::dot(velocity, velocity);
    const double b = glm::dot(velocity, straight);
    const double c = glm::dot(straight, straight) - reach * reach;  // at most 0: rest is always near enough
    if (a - 2.0 * b + c <= 0.0) return 1.0;
    return (b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
  }

  std::vector<double> times_s_;
  std::vector<Vec> points_;
  std::vector<Vec> velocities_;  // radians a second, tangent at the points
};

}  // namespace scripts
