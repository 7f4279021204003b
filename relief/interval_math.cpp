#include "relief/interval_math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief {

namespace {

// Returns how far x lies beyond [low, high].
double beyond(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }

Interval beyond_of(double x0, double x1, double low, double high) {
  const double nearest = x1 < low ? low - x1 : x0 > high ? x0 - high : 0.0;
  return {nearest, std::max(beyond(x0, low, high), beyond(x1, low, high))};
}

}  // namespace

Interval widened(const Interval& a, double by) { return {a.low - by, a.high + by}; }

Interval absolute(const Interval& a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return {-a.high, -a.low};
  return {0, std::max(-a.low, a.high)};
}

Rect whole_plane() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {-kInfinity, -kInfinity, kInfinity, kInfinity};
}

Rect centred_rect(double half_x_m, double half_y_m) { return {-half_x_m, -half_y_m, half_x_m, half_y_m}; }

Rect grown(const Rect& a, double by_m) { return {a.x0_m - by_m, a.y0_m - by_m, a.x1_m + by_m, a.y1_m + by_m}; }

Rect intersection(const Rect& a, const Rect& b) {
  return {std::max(a.x0_m, b.x0_m), std::max(a.y0_m, b.y0_m), std::min(a.x1_m, b.x1_m),
          std::min(a.y1_m, b.y1_m)};
}

bool contains(const Rect& outer, const Rect& inner) {
  return outer.x0_m <= inner.x0_m && outer.y0_m <= inner.y0_m && inner.x1_m <= outer.x1_m &&
         inner.y1_m <= outer.y1_m;
}

bool contains(const Rect& rect, double x_m, double y_m) {
  return rect.x0_m <= x_m && x_m <= rect.x1_m && rect.y0_m <= y_m && y_m <= rect.y1_m;
}

double radius_of(double x_m, double y_m) { return std::sqrt(x_m * x_m + y_m * y_m); }

Interval radii_of(const Rect& rect) {
  const Interval x = absolute({rect.x0_m, rect.x1_m});
  const Interval y = absolute({rect.y0_m, rect.y1_m});
  return {radius_of(x.low, y.low), radius_of(x.high, y.high)};
}

double distance_of(const Rect& box, double x_m, double y_m) {
  return radius_of(beyond(x_m, box.x0_m, box.x1_m), beyond(y_m, box.y0_m, box.y1_m));
}

Interval distances_of(const Rect& box, const Rect& rect) {
  const Interval x = beyond_of(rect.x0_m, rect.x1_m, box.x0_m, box.x1_m);
  const Interval y = beyond_of(rect.y0_m, rect.y1_m, box.y0_m, box.y1_m);
  return {radius_of(x.low, y.low), radius_of(x.high, y.high)};
}

glm::dvec2 nearest_of(const Rect& box, double x_m, double y_m) {
  return {std::clamp(x_m, box.x0_m, box.x1_m), std::clamp(y_m, box.y0_m, box.y1_m)};
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double smooth_step_slope(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return 6 * t * (1 - t);
}

}  // namespace relief
