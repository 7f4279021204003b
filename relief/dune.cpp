#include "relief/dune.h"

#include <algorithm>
#include <cmath>

#include "relief/earthworks.h"
#include "relief/interval_math.h"

namespace relief {

namespace {

constexpr double kStraightShare = 0.6;  // of a transverse dune

}  // namespace

DuneShape::DuneShape(const DuneSize& size) : size_(size), slope_(slope_of(size.repose_deg)) {}

// Returns the height of the crest. It descends with v >= 0.
double DuneShape::crest_m(double v) const {
  if (v >= 1) return 0;
  if (!size_.is_barchan) return size_.height_m * smooth_step((1 - v) / (1 - kStraightShare));
  const double t = 1 - v * v;
  return size_.height_m * t * t;
}

double DuneShape::crest_slope_m(double v) const {
  if (v >= 1) return 0;
  if (size_.is_barchan) return -4 * size_.height_m * v * (1 - v * v);
  return -size_.height_m * smooth_step_slope((1 - v) / (1 - kStraightShare)) / (1 - kStraightShare);
}

// Returns the height at a way downwind of the crest. It ascends with the crest, and up to a way of 0.
double DuneShape::profile_m(double way_m, double crest_m) const {
  if (way_m >= 0) return std::max(0.0, crest_m - slope_ * way_m);
  const double t = std::max(-1.0, way_m / size_.stoss_m);
  return crest_m * (1 - t * t);
}

Rect DuneShape::support() const {
  return {-size_.stoss_m, -size_.width_m / 2, size_.horn_m + size_.height_m / slope_, size_.width_m / 2};
}

double DuneShape::height_m(double x_m, double y_m) const {
  if (!contains(support(), x_m, y_m)) return 0;
  const double v = std::abs(y_m) / (size_.width_m / 2);
  return profile_m(x_m - size_.horn_m * (v * v), crest_m(v));
}

glm::dvec2 DuneShape::gradient(double x_m, double y_m) const {
  const double v = std::abs(y_m) / (size_.width_m / 2);
  const double crest = crest_m(v);
  if (!contains(support(), x_m, y_m) || v >= 1 || crest <= 0) return {0, 0};
  const double way_m = x_m - size_.horn_m * (v * v);
  double by_way = 0;
  double by_crest = 0;
  if (way_m >= 0 && crest > slope_ * way_m) {
    by_way = -slope_;
    by_crest = 1;
  } else if (way_m < 0 && way_m > -size_.stoss_m) {
    const double t = way_m / size_.stoss_m;
    by_way = -2 * crest * t / size_.stoss_m;
    by_crest = 1 - t * t;
  }
  const double by_v = by_crest * crest_slope_m(v) - by_way * 2 * size_.horn_m * v;
  return {by_way, by_v * (y_m < 0 ? -1 : 1) / (size_.width_m / 2)};
}

Interval DuneShape::bounds_m(const Rect& rect) const {
  if (!overlap(rect, support())) return {0, 0};
  const Rect inner = intersection(rect, support());
  const Interval y_m = absolute({inner.y0_m, inner.y1_m});
  const Interval v{y_m.low / (size_.width_m / 2), y_m.high / (size_.width_m / 2)};
  const Interval crest{crest_m(v.high), crest_m(v.low)};
  const Interval way{inner.x0_m - size_.horn_m * (v.high * v.high),
                     inner.x1_m - size_.horn_m * (v.low * v.low)};
  const double lowest_m = std::min(profile_m(way.low, crest.low), profile_m(way.high, crest.low));
  const double highest_m = profile_m(std::clamp(0.0, way.low, way.high), crest.high);
  const double rounding_m = kRounding * (size_.height_m + slope_ * (size_.horn_m + size_.stoss_m));
  return {contains(support(), rect) ? std::max(0.0, lowest_m - rounding_m) : 0.0, highest_m + rounding_m};
}

}  // namespace relief
