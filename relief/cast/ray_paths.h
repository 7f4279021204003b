// A surface along one ray: the height above its base, the place in a chart, the height over the ground.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "relief/cast/ray_caster.h"
#include "relief/cast/ray_forms.h"

namespace relief {

inline LinearOnRay on_ray(const Linear& f, const Ray& ray) {
  return {f.at(ray.origin_m), glm::dot(f.normal, ray.direction)};
}

inline QuadraticOnRay on_ray(const Quadratic& f, const Ray& ray) {
  const glm::dvec3 d = ray.origin_m - f.centre_m;
  const glm::dvec3 turned = f.matrix * ray.direction;
  return {f.constant + 2 * glm::dot(f.linear, d) + glm::dot(d, f.matrix * d),
          glm::dot(f.linear, ray.direction) + glm::dot(d, turned), glm::dot(ray.direction, turned)};
}

inline Ray moved(const Ray& ray, double s) { return {ray.origin_m + s * ray.direction, ray.direction}; }

// Holds the height above a base along a ray.
class HeightOnRay {
 public:
  HeightOnRay(const Base& base, const Ray& ray) : base_(base), n1_(on_ray(base.first(), ray)) {
    if (base.kind() == Base::Kind::kEllipsoid) n2_ = on_ray(base.second(), ray);
  }

  double value(double s) const { return base_.height_of(n1_.at(s), n2_.at(s)); }

  Interval over(double s0, double s1) const {
    if (base_.kind() != Base::Kind::kEllipsoid) return base_.height_of(bundle(n1_).over(s0, s1), {});
    return base_.height_of(bundle(n1_).over(s0, s1), bundle(n2_).over(s0, s1));
  }

  double derivative(double s) const { return base_.slope_of(along(s)); }
  Interval slope(double s0, double s1) const { return base_.slope_of(along(s0), along(s1), s1 - s0); }

 private:
  static QuadraticOnBundle bundle(const QuadraticOnRay& f) { return {f.c, {f.l, f.l}, {f.q, f.q}}; }
  Base::Along along(double s) const { return {n1_.at(s), n1_.half_slope(s), n2_.at(s), n2_.half_slope(s)}; }

  const Base& base_;
  QuadraticOnRay n1_;
  QuadraticOnRay n2_;
};

// Holds a coordinate of a chart along a ray, (coordinate - zero) / unit. It never turns back.
class CoordinateOnRay {
 public:
  CoordinateOnRay(const LinearOnRay& x, const LinearOnRay& w, double zero, double unit)
      : x_{(x.c - zero * w.c) / unit, (x.r - zero * w.r) / unit}, w_(w) {}

  double at(double s) const { return w_.r == 0 && w_.c == 1 ? x_.at(s) : x_.at(s) / w_.at(s); }

  // Returns the derivative by s.
  double rate(double s) const {
    const double w = w_.at(s);
    return (x_.r * w_.c - x_.c * w_.r) / (w * w);
  }

  // Returns the s at which the coordinate is `value`: infinite or not a number if it is that nowhere.
  double where(double value) const { return (value * w_.c - x_.c) / (x_.r - value * w_.r); }

  // Bounds the rounding of at() from s0 to s1.
  double rounding(double s0, double s1) const {
    const double least_w = std::min(std::abs(w_.at(s0)), std::abs(w_.at(s1)));
    return 4 * kFormRounding * (std::abs(x_.c) + s1 * std::abs(x_.r)) / least_w;
  }

 private:
  LinearOnRay x_;
  LinearOnRay w_;
};

// Holds the height over a bare base along a ray, as first_root() asks for it.
struct BareOnRay {
  const HeightOnRay& height;

  double value(double s) const { return height.value(s); }
  double derivative(double s) const { return height.derivative(s); }
  Interval slope(double a, double b) const { return height.slope(a, b); }
};

// Holds the height over a patch along a ray, likewise. (i, j) is the cell; x and y are in cells.
struct PatchOnRay {
  const HeightOnRay& height;
  const CoordinateOnRay& x;
  const CoordinateOnRay& y;
  double i = 0;
  double j = 0;
  const Patch& patch;
  const PatchSlopes& slopes;

  double value(double s) const { return height.value(s) - patch.height_m(x.at(s) - i, y.at(s) - j); }
  double derivative(double s) const {
    const glm::dvec2 rise = patch.gradient(x.at(s) - i, y.at(s) - j);
    return height.derivative(s) - (rise.x * x.rate(s) + rise.y * y.rate(s));
  }
  Interval slope(double a, double b) const {
    constexpr double kSlack = 1e-12;  // cells: more than rounding
    const PatchSlopes::Slopes rise = slopes.over(widened(between(x.at(a) - i, x.at(b) - i), kSlack),
                                                 widened(between(y.at(a) - j, y.at(b) - j), kSlack));
    const Interval ground =
        sum(product(rise.u, between(x.rate(a), x.rate(b))), product(rise.v, between(y.rate(a), y.rate(b))));
    return difference(height.slope(a, b), ground);
  }
};

}  // namespace relief
