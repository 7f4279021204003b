#include "relief/field/patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relief/field/interval_algebra.h"

namespace relief {

namespace {

// Bezier points of the Catmull-Rom segment from b to c.
std::array<double, 4> bezier(double a, double b, double c, double d) {
  return {b, b + (c - a) / 6, c - (d - b) / 6, c};
}

std::array<double, 4> weights(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

std::array<double, 4> weight_slopes(double t) {
  const double s = 1 - t;
  return {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t};
}

double tensor(const std::array<double, 16>& points, const std::array<double, 4>& u,
              const std::array<double, 4>& v) {
  double total = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    const double* row = &points[4 * j];
    total += v[j] * ((row[0] * u[0] + row[1] * u[1]) + (row[2] * u[2] + row[3] * u[3]));
  }
  return total;
}

// What rounding can add to a sum of products of the points.
double rounding(double largest) { return 32 * std::numeric_limits<double>::epsilon() * largest; }

}  // namespace

Patch Patch::bilinear(double h00, double h10, double h01, double h11) {
  Patch patch;
  patch.points_m_ = {h00, h10, h01, h11};
  return patch;
}

Patch Patch::bicubic(const std::array<double, 16>& posts_m) {
  std::array<std::array<double, 4>, 4> rows;
  for (std::size_t j = 0; j < 4; ++j) {
    const double* p = &posts_m[4 * j];
    rows[j] = bezier(p[0], p[1], p[2], p[3]);
  }
  Patch patch;
  patch.interpolation_ = Interpolation::kBicubic;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<double, 4> column = bezier(rows[0][i], rows[1][i], rows[2][i], rows[3][i]);
    for (std::size_t j = 0; j < 4; ++j) patch.points_m_[4 * j + i] = column[j];
  }
  return patch;
}

double Patch::height_m(double u, double v) const {
  if (interpolation_ == Interpolation::kBicubic) return tensor(points_m_, weights(u), weights(v));
  const double low = points_m_[0] + u * (points_m_[1] - points_m_[0]);
  const double high = points_m_[2] + u * (points_m_[3] - points_m_[2]);
  return low + v * (high - low);
}

glm::dvec2 Patch::gradient(double u, double v) const {
  if (interpolation_ == Interpolation::kBicubic)
    return {tensor(points_m_, weight_slopes(u), weights(v)), tensor(points_m_, weights(u), weight_slopes(v))};
  const double low = points_m_[1] - points_m_[0];
  const double high = points_m_[3] - points_m_[2];
  const double left = points_m_[2] - points_m_[0];
  const double right = points_m_[3] - points_m_[1];
  return {low + v * (high - low), left + u * (right - left)};
}

Interval Patch::bounds_m() const {
  const auto end = points_m_.begin() + (interpolation_ == Interpolation::kBicubic ? 16 : 4);
  const auto [low, high] = std::minmax_element(points_m_.begin(), end);
  return {*low, *high};
}

Interval Patch::bounds_m(const Interval& u, const Interval& v) const {
  const Interval all = bounds_m();
  const double slack = rounding(std::max(std::abs(all.low), std::abs(all.high)));
  if (interpolation_ == Interpolation::kBicubic) {
    const PatchSlopes::Slopes slopes = PatchSlopes(*this).over(u, v);
    const auto most = [](const Interval& slope) { return std::max(std::abs(slope.low), std::abs(slope.high)); };
    const double value = height_m(middle(u), middle(v));
    const double reach = 0.5 * (most(slopes.u) * width(u) + most(slopes.v) * width(v));
    return common(widened({value, value}, reach + slack), widened(all, slack));
  }
  const Interval low = between(height_m(u.low, v.low), height_m(u.high, v.low));
  const Interval high = between(height_m(u.low, v.high), height_m(u.high, v.high));
  return widened(hull(low, high), slack);
}

double Patch::facet_deviation_m() const {
  if (interpolation_ == Interpolation::kBilinear)
    return std::abs(points_m_[0] - points_m_[1] - points_m_[2] + points_m_[3]) / 4;
  const Patch flat = bilinear(points_m_[0], points_m_[3], points_m_[12], points_m_[15]);
  double most = 0;
  for (std::size_t n = 0; n < 16; ++n) {
    const double level = flat.height_m(static_cast<double>(n % 4) / 3, static_cast<double>(n / 4) / 3);
    most = std::max(most, std::abs(points_m_[n] - level));
  }
  return flat.facet_deviation_m() + most * 15 / 16;
}

PatchSlopes::PatchSlopes(const Patch& patch) : patch_(patch) {
  if (patch.interpolation() == Interpolation::kBilinear) return;
  const auto& p = patch.points_m_;
  Interval u{p[1] - p[0], p[1] - p[0]};
  Interval v{p[4] - p[0], p[4] - p[0]};
  const auto add = [](Interval& range, double value) {
    range = {std::min(range.low, value), std::max(range.high, value)};
  };
  double largest = 0;
  for (std::size_t j = 0; j < 16; j += 4) {
    for (std::size_t n = j; n < j + 3; ++n) add(u, p[n + 1] - p[n]);
    for (std::size_t n = j; n < j + 2; ++n) uu_ = std::max(uu_, std::abs(p[n] - 2 * p[n + 1] + p[n + 2]));
    for (std::size_t n = j; n < j + 4; ++n) largest = std::max(largest, std::abs(p[n]));
  }
  for (std::size_t n = 0; n < 12; ++n) add(v, p[n + 4] - p[n]);
  for (std::size_t n = 0; n < 8; ++n) vv_ = std::max(vv_, std::abs(p[n] - 2 * p[n + 4] + p[n + 8]));
  for (std::size_t j = 0; j < 12; j += 4)
    for (std::size_t n = j; n < j + 3; ++n)
      uv_ = std::max(uv_, std::abs(p[n] - p[n + 1] - p[n + 4] + p[n + 5]));
  uu_ *= 6;
  vv_ *= 6;
  uv_ *= 9;
  u_ = widened(scaled(u, 3), rounding(largest));
  v_ = widened(scaled(v, 3), rounding(largest));
  slack_ = rounding(2 * largest);
}

PatchSlopes::Slopes PatchSlopes::over(const Interval& u, const Interval& v) const {
  if (patch_.interpolation() == Interpolation::kBilinear) {
    const glm::dvec2 low = patch_.gradient(u.low, v.low);
    const glm::dvec2 high = patch_.gradient(u.high, v.high);
    return {between(low.x, high.x), between(low.y, high.y)};
  }
  const glm::dvec2 slope = patch_.gradient(middle(u), middle(v));
  const double du = 0.5 * width(u);
  const double dv = 0.5 * width(v);
  return {common(widened({slope.x, slope.x}, uu_ * du + uv_ * dv + slack_), u_),
          common(widened({slope.y, slope.y}, uv_ * du + vv_ * dv + slack_), v_)};
}

}  // namespace relief
