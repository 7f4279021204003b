#include "relief/field/base.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "relief/field/interval_algebra.h"

namespace relief {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kLeastNorm = 1e-6;  // of an ellipsoid's norm: its inverse stays finite

bool is_finite_vector(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void require(bool is_met, const char* problem) {
  if (!is_met) throw std::invalid_argument(problem);
}

Interval root(const Interval& n) {
  // A square root is right within half a unit of its last place.
  return {std::sqrt(std::max(n.low, 0.0)) * (1 - kEpsilon), std::sqrt(std::max(n.high, 0.0)) * (1 + kEpsilon)};
}

// Derivatives by s of the length sqrt(n(s)), which is convex on a ray: they grow from end to end.
Interval length_slope(double n_low, double half_low, double n_high, double half_high) {
  const double tiny = std::numeric_limits<double>::min();
  return between(half_low / std::sqrt(std::max(n_low, tiny)), half_high / std::sqrt(std::max(n_high, tiny)));
}

}  // namespace

double Quadratic::value(const glm::dvec3& p_m) const {
  const glm::dvec3 d = p_m - centre_m;
  return constant + 2.0 * glm::dot(linear, d) + glm::dot(d, matrix * d);
}

glm::dvec3 Quadratic::gradient(const glm::dvec3& p_m) const {
  return 2.0 * (linear + matrix * (p_m - centre_m));
}

Interval bounds(const Quadratic& polynomial, const Box& box) {
  const glm::dvec3 middle_m = 0.5 * (box.low_m + box.high_m);
  const glm::dvec3 half = 0.5 * (box.high_m - box.low_m);
  const glm::dvec3 slope = polynomial.gradient(middle_m);
  const glm::dvec3 far = glm::abs(middle_m - polynomial.centre_m) + half;
  const double value = polynomial.value(middle_m);
  Interval found{value, value};
  double size = std::abs(polynomial.constant);
  for (int i = 0; i < 3; ++i) {
    found = widened(found, std::abs(slope[i]) * half[i]);
    const double square = polynomial.matrix[i][i] * half[i] * half[i];
    found.low += std::min(square, 0.0);
    found.high += std::max(square, 0.0);
    size += 2 * std::abs(polynomial.linear[i]) * far[i];
    for (int j = 0; j < 3; ++j) size += std::abs(polynomial.matrix[i][j]) * far[i] * far[j];
    for (int j = 0; j < i; ++j)
      found = widened(found, 2 * std::abs(polynomial.matrix[i][j]) * half[i] * half[j]);
  }
  return widened(found, 16 * kEpsilon * size);
}

Base Base::plane(const glm::dvec3& point_m, const glm::dvec3& normal) {
  require(is_finite_vector(point_m) && is_finite_vector(normal),
          "a plane as base: not all its numbers are finite");
  const double length = glm::length(normal);
  require(length > 0 && std::isfinite(length), "a plane as base: its normal must have a length");
  Base base;
  base.first_.centre_m = point_m;
  base.first_.linear = normal / (2.0 * length);
  return base;
}

Base Base::sphere(const glm::dvec3& centre_m, double radius_m) {
  require(is_finite_vector(centre_m) && std::isfinite(radius_m),
          "a sphere as base: not all its numbers are finite");
  require(radius_m > 0, "a sphere as base: its radius must be positive");
  Base base;
  base.kind_ = Kind::kSphere;
  base.first_.centre_m = centre_m;
  base.first_.matrix = glm::dmat3(1.0);
  base.radius_m_ = radius_m;
  return base;
}

Base Base::ellipsoid(const glm::dvec3& centre_m, const glm::dvec3& semi_axes_m, const glm::dmat3& axes) {
  require(is_finite_vector(centre_m) && is_finite_vector(semi_axes_m),
          "an ellipsoid as base: not all its numbers are finite");
  require(semi_axes_m.x > 0 && semi_axes_m.y > 0 && semi_axes_m.z > 0,
          "an ellipsoid as base: its semi-axes must be positive");
  Base base;
  base.kind_ = Kind::kEllipsoid;
  base.first_.centre_m = centre_m;
  base.first_.matrix = glm::dmat3(1.0);
  base.second_.centre_m = centre_m;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const double product = glm::dot(axes[k], axes[j]);
      require(std::abs(product - (j == k ? 1 : 0)) <= 1e-9,
              "an ellipsoid as base: the directions of its axes must be orthonormal");
    }
    base.second_.matrix += glm::outerProduct(axes[k], axes[k]) / (semi_axes_m[k] * semi_axes_m[k]);
  }
  return base;
}

Base Base::quadric(const Quadratic& f, const glm::dvec3& anchor_m) {
  bool is_finite = is_finite_vector(f.centre_m) && is_finite_vector(f.linear) && std::isfinite(f.constant) &&
                   is_finite_vector(anchor_m);
  for (int k = 0; k < 3; ++k) is_finite = is_finite && is_finite_vector(f.matrix[k]);
  require(is_finite, "a quadric as base: not all its numbers are finite");
  require(f.matrix == glm::transpose(f.matrix), "a quadric as base: its matrix must be symmetric");
  const double slope = glm::length(f.gradient(anchor_m));
  require(slope > 0 && std::isfinite(slope),
          "a quadric as base: its gradient is 0 at the anchor; choose another one");
  Base base;
  base.kind_ = Kind::kQuadric;
  base.first_ = {f.centre_m, f.matrix / slope, f.linear / slope, f.constant / slope};
  return base;
}

double Base::height_m(const glm::dvec3& p_m) const {
  const double n1 = first_.value(p_m);
  return height_of(n1, kind_ == Kind::kEllipsoid ? second_.value(p_m) : 0);
}

glm::dvec3 Base::gradient(const glm::dvec3& p_m) const {
  if (kind_ == Kind::kPlane || kind_ == Kind::kQuadric) return first_.gradient(p_m);
  const glm::dvec3 d = p_m - first_.centre_m;
  const double r = glm::length(d);
  if (!(r > 0)) return {0, 0, 0};
  if (kind_ == Kind::kSphere) return d / r;
  const double g = std::sqrt(second_.value(p_m));
  return (1 - 1 / g) / r * d + r / (2 * g * g * g) * second_.gradient(p_m);
}

Interval Base::bounds_m(const Box& box) const {
  return height_of(bounds(first_, box), kind_ == Kind::kEllipsoid ? bounds(second_, box) : Interval{});
}

double Base::height_of(double n1, double n2) const {
  if (kind_ == Kind::kPlane || kind_ == Kind::kQuadric) return n1;
  const double r = std::sqrt(std::max(n1, 0.0));
  if (kind_ == Kind::kSphere) return r - radius_m_;
  return r * (1 - 1 / std::max(std::sqrt(std::max(n2, 0.0)), kLeastNorm));
}

Interval Base::height_of(const Interval& n1, const Interval& n2) const {
  if (kind_ == Kind::kPlane || kind_ == Kind::kQuadric) return n1;
  const Interval r = root(n1);
  if (kind_ == Kind::kSphere)
    return widened({r.low - radius_m_, r.high - radius_m_}, kEpsilon * (r.high + radius_m_));
  const Interval g = root(n2);
  const Interval share{1 - 1 / std::max(g.low, kLeastNorm), 1 - 1 / std::max(g.high, kLeastNorm)};
  return widened(product(r, share), 4 * kEpsilon * r.high * (1 + 1 / std::max(g.low, kLeastNorm)));
}

double Base::slope_of(const Along& at) const {
  if (kind_ == Kind::kPlane || kind_ == Kind::kQuadric) return 2 * at.half1;
  const double r = std::sqrt(at.n1);
  if (kind_ == Kind::kSphere) return at.half1 / r;
  const double g = std::sqrt(at.n2);
  return at.half1 / r * (1 - 1 / g) + r * at.half2 / (at.n2 * g);
}

Interval Base::slope_of(const Along& at, const Along& to, double ds) const {
  if (kind_ == Kind::kPlane || kind_ == Kind::kQuadric) return between(2 * at.half1, 2 * to.half1);
  const Interval r_slope = length_slope(at.n1, at.half1, to.n1, to.half1);
  if (kind_ == Kind::kSphere) return r_slope;
  // The lengths are convex: their largest values lie at the ends, their least at an end or between.
  const auto length = [ds](double n_low, double half_low, double n_high, double half_high) {
    const double high = std::max(n_low, n_high);
    double least = std::min(n_low, n_high);
    if (half_low < 0 && half_high > 0)
      least = std::min(least, n_low - half_low * half_low * ds / (half_high - half_low) - 1e-12 * high);
    return Interval{std::sqrt(std::max(least, 0.0)), std::sqrt(std::max(high, 0.0))};
  };
  const Interval g_slope = length_slope(at.n2, at.half2, to.n2, to.half2);
  const Interval r = length(at.n1, at.half1, to.n1, to.half1);
  Interval g = length(at.n2, at.half2, to.n2, to.half2);
  g = {std::max(g.low, kLeastNorm), std::max(g.high, kLeastNorm)};
  const Interval share{1 - 1 / g.low, 1 - 1 / g.high};
  const Interval ratio{r.low / (g.high * g.high), r.high / (g.low * g.low)};
  return sum(product(r_slope, share), product(ratio, g_slope));
}

}  // namespace relief
