// Long double implementations of the geometry, directly from the definitions, to measure rounding errors.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"
#include "tests/support/worst.h"

namespace mars::exact {

using Real = long double;
inline const Real kPi = std::acos(-1.0L);

struct Vec {
  Real x, y, z;
};
inline Vec vec(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(const Vec& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
inline Real dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real length(const Vec& a) { return std::sqrt(dot(a, a)); }
inline Real angle(const Vec& a, const Vec& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// Multiples of 90 degrees are subtracted exactly before degrees become radians, so that small values keep all
// digits.
inline Real sin_deg(double deg) {
  const Real reduced = std::remainder(static_cast<Real>(deg), 360.0L);
  const Real quarter = std::nearbyint(reduced / 90);
  const Real rest = (reduced - 90 * quarter) * kPi / 180;
  if (quarter == 0) return std::sin(rest);
  if (quarter == 1) return std::cos(rest);
  return quarter == -1 ? -std::cos(rest) : -std::sin(rest);
}
inline Real cos_deg(double deg) {
  const Real reduced = std::remainder(static_cast<Real>(deg), 360.0L);
  const Real quarter = std::nearbyint(reduced / 90);
  const Real rest = (reduced - 90 * quarter) * kPi / 180;
  if (quarter == 0) return std::cos(rest);
  if (quarter == 1) return -std::sin(rest);
  return quarter == -1 ? std::sin(rest) : -std::cos(rest);
}

inline Vec direction(LonLat p) {
  return {cos_deg(p.lat_deg) * cos_deg(p.lon_deg), cos_deg(p.lat_deg) * sin_deg(p.lon_deg), sin_deg(p.lat_deg)};
}

// Checks a stated bound over many cases, and at the end that it is not too loose: the worst case must reach at
// least a twentieth of it.
class Bound {
 public:
  explicit Bound(const char* name) : name_(name) {}
  ~Bound() {
    EXPECT_GE(worst_, 1.0L / 20) << name_ << " is lazy";
    test_support::record_worst(name_, static_cast<double>(worst_), 1.0, "of the bound in the header");
  }
  Bound(const Bound&) = delete;
  Bound& operator=(const Bound&) = delete;

  void add(Real error, Real bound) {
    if (!(error / bound <= worst_)) worst_ = std::isnan(error) ? INFINITY : error / bound;
  }

 private:
  const char* name_;
  Real worst_ = 0;
};

}  // namespace mars::exact
