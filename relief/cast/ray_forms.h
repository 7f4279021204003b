// Functions of points of space along rays, and over bundles of rays.
//
// The points of a ray are o + s q with q = x right + y up + forward: s is the depth along `forward`. A function of first
// degree is c + s r there, one of second degree c + 2 s l + s^2 q. For the rays of a rectangle of tangents (x, y), r, l
// and q lie in intervals, and with s >= 0 the function is bounded by their ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "relief/field/base.h"
#include "relief/field/chart.h"
#include "relief/field/interval_algebra.h"

namespace relief {

// Bounds the rounding of a form's value relative to the sum of its terms.
inline constexpr double kFormRounding = 2e-15;

// Returns where an interval of depths is halved: in the middle, or in the geometric mean where it is long for its distance.
inline double split(double s0, double s1) {
  if (s1 <= 4 * s0) return 0.5 * (s0 + s1);
  return s0 > 0 ? std::sqrt(s0) * std::sqrt(s1) : s1 / 16;
}

struct RayAxes {
  glm::dvec3 origin_m{0, 0, 0};
  glm::dvec3 right{0, 0, 0};
  glm::dvec3 up{0, 0, 0};
  glm::dvec3 forward{0, 0, 0};
};

// Holds the tangents (x, y) of a bundle of rays.
struct Tangents {
  double x0 = 0;
  double x1 = 0;
  double y0 = 0;
  double y1 = 0;
};

// Holds a function of first degree on one ray.
struct LinearOnRay {
  double c = 0;
  double r = 0;

  double at(double s) const { return c + s * r; }
};

// Holds a function of first degree on a bundle of rays.
struct LinearOnBundle {
  double c = 0;
  Interval r;

  // Returns an interval for all s from s0 to s1, 0 <= s0 <= s1.
  Interval over(double s0, double s1) const {
    const double slack = kFormRounding * (std::abs(c) + s1 * std::max(std::abs(r.low), std::abs(r.high)));
    return {c + (r.low < 0 ? s1 : s0) * r.low - slack, c + (r.high > 0 ? s1 : s0) * r.high + slack};
  }
};

// Holds a function of first degree as seen from the axes: its value is c + s (x right + y up + forward).
struct LinearForm {
  double c = 0;
  glm::dvec3 rates{0, 0, 0};

  LinearForm() = default;
  LinearForm(const Linear& f, const RayAxes& axes)
      : c(f.at(axes.origin_m)),
        rates(glm::dot(f.normal, axes.right), glm::dot(f.normal, axes.up), glm::dot(f.normal, axes.forward)) {}

  double rate(double x, double y) const { return x * rates.x + y * rates.y + rates.z; }

  LinearOnBundle bundle(const Tangents& t) const {
    const double middle_rate = rate(0.5 * (t.x0 + t.x1), 0.5 * (t.y0 + t.y1));
    const double reach = 0.5 * (std::abs(rates.x) * (t.x1 - t.x0) + std::abs(rates.y) * (t.y1 - t.y0));
    return {c, {middle_rate - reach, middle_rate + reach}};
  }
};

// Holds a function of second degree on one ray.
struct QuadraticOnRay {
  double c = 0;
  double l = 0;
  double q = 0;

  double at(double s) const { return c + s * (2 * l + s * q); }
  double half_slope(double s) const { return l + s * q; }
};

// Holds a function of second degree on a bundle of rays.
struct QuadraticOnBundle {
  double c = 0;
  Interval l;
  Interval q;

  Interval over(double s0, double s1) const {
    const QuadraticOnRay least{c, l.low, q.low};
    const QuadraticOnRay most{c, l.high, q.high};
    Interval found{std::min(least.at(s0), least.at(s1)), std::max(most.at(s0), most.at(s1))};
    // A turning point at s = -l / q lies between if the slope changes its sign.
    if (q.low > 0 && least.half_slope(s0) < 0 && least.half_slope(s1) > 0)
      found.low = std::min(found.low, c - l.low * l.low / q.low);
    if (q.high < 0 && most.half_slope(s0) > 0 && most.half_slope(s1) < 0)
      found.high = std::max(found.high, c - l.high * l.high / q.high);
    const double l_size = std::max(std::abs(l.low), std::abs(l.high));
    const double q_size = std::max(std::abs(q.low), std::abs(q.high));
    return widened(found, kFormRounding * (std::abs(c) + s1 * (2 * l_size + s1 * q_size)));
  }
};

// Holds a function of second degree as seen from the axes.
struct QuadraticForm {
  double c = 0;
  glm::dvec3 slopes{0, 0, 0};  // half the gradient at the origin, along the axes
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;

  QuadraticForm() = default;
  QuadraticForm(const Quadratic& f, const RayAxes& axes) : c(f.value(axes.origin_m)) {
    const glm::dvec3 half = 0.5 * f.gradient(axes.origin_m);
    slopes = {glm::dot(half, axes.right), glm::dot(half, axes.up), glm::dot(half, axes.forward)};
    const glm::dvec3 right = f.matrix * axes.right;
    const glm::dvec3 up = f.matrix * axes.up;
    const glm::dvec3 forward = f.matrix * axes.forward;
    xx = glm::dot(axes.right, right);
    xy = glm::dot(axes.right, up);
    yy = glm::dot(axes.up, up);
    xz = glm::dot(axes.right, forward);
    yz = glm::dot(axes.up, forward);
    zz = glm::dot(axes.forward, forward);
  }

  QuadraticOnRay ray(double x, double y) const {
    return {c, x * slopes.x + y * slopes.y + slopes.z,
            x * (x * xx + 2 * (y * xy + xz)) + y * (y * yy + 2 * yz) + zz};
  }

  QuadraticOnBundle bundle(const Tangents& t) const {
    const double x = 0.5 * (t.x0 + t.x1);
    const double y = 0.5 * (t.y0 + t.y1);
    const double dx = 0.5 * (t.x1 - t.x0);
    const double dy = 0.5 * (t.y1 - t.y0);
    const QuadraticOnRay mid = ray(x, y);
    const double l_reach = std::abs(slopes.x) * dx + std::abs(slopes.y) * dy;
    // The second-order terms keep their sign on the diagonal of the matrix.
    const double q_reach = 2 * (std::abs(x * xx + y * xy + xz) * dx + std::abs(x * xy + y * yy + yz) * dy) +
                           2 * std::abs(xy) * dx * dy;
    const double square_x = xx * dx * dx;
    const double square_y = yy * dy * dy;
    return {c,
            {mid.l - l_reach, mid.l + l_reach},
            {mid.q - q_reach + std::min(square_x, 0.0) + std::min(square_y, 0.0),
             mid.q + q_reach + std::max(square_x, 0.0) + std::max(square_y, 0.0)}};
  }
};

}  // namespace relief
