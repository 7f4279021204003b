#include "relief/crater.h"

#include <algorithm>
#include <cmath>

#include "relief/interval_math.h"

namespace relief {

namespace {

constexpr double kLeastPeakRatio = 0.15;
constexpr double kMostFloorRatio = 0.9;

}  // namespace

CraterSize mars_crater(double radius_m) {
  CraterSize size;
  size.radius_m = radius_m;
  const double diameter_km = 2 * radius_m / 1000;
  size.depth_m = 1000 * std::min(0.2 * diameter_km, 0.36 * std::pow(diameter_km, 0.49));
  size.rim_m = size.depth_m / 5;
  const double is_complex = smooth_step(2 * radius_m / kComplexDiameter_m - 1);
  if (is_complex > 0) {
    size.floor_ratio = is_complex * std::min(0.187 * std::pow(diameter_km, 0.249), kMostFloorRatio);
    size.peak_m = is_complex * std::min(40 * std::pow(diameter_km, 0.51), size.depth_m / 2);
  }
  return size;
}

CraterShape::CraterShape(const CraterSize& size)
    : size_(size),
      peak_ratio_(std::max(kLeastPeakRatio, size.floor_ratio / 2)),
      fade_ratio_((1 + size.ejecta_ratio) / 2) {}

double CraterShape::bowl_m(double ratio) const {
  const double t = std::max(0.0, (ratio - size_.floor_ratio) / (1 - size_.floor_ratio));
  return size_.rim_m - size_.depth_m * (1 - t * t);
}

double CraterShape::peak_m(double ratio) const { return size_.peak_m * smooth_step(1 - ratio / peak_ratio_); }

double CraterShape::ejecta_m(double ratio) const {
  if (ratio >= size_.ejecta_ratio) return 0;
  const double fade = smooth_step((size_.ejecta_ratio - ratio) / (size_.ejecta_ratio - fade_ratio_));
  return size_.rim_m * fade / (ratio * ratio * ratio);
}

Rect CraterShape::support() const {
  return centred_rect(size_.radius_m * size_.ejecta_ratio, size_.radius_m * size_.ejecta_ratio);
}

double CraterShape::height_m(double x_m, double y_m) const {
  const double ratio = radius_of(x_m, y_m) / size_.radius_m;
  return ratio < 1 ? bowl_m(ratio) + peak_m(ratio) : ejecta_m(ratio);
}

glm::dvec2 CraterShape::gradient(double x_m, double y_m) const {
  const double r_m = radius_of(x_m, y_m);
  const double ratio = r_m / size_.radius_m;
  if (!(r_m > 0) || ratio >= size_.ejecta_ratio) return {0, 0};
  double slope = 0;  // of the height by the ratio
  if (ratio < 1) {
    const double inner = 1 - size_.floor_ratio;
    slope = 2 * size_.depth_m * std::max(0.0, (ratio - size_.floor_ratio) / inner) / inner -
            size_.peak_m * smooth_step_slope(1 - ratio / peak_ratio_) / peak_ratio_;
  } else {
    const double way = size_.ejecta_ratio - fade_ratio_;
    const double t = (size_.ejecta_ratio - ratio) / way;
    const double cube = ratio * ratio * ratio;
    slope = -size_.rim_m * (smooth_step_slope(t) / way + 3 * smooth_step(t) / ratio) / cube;
  }
  return glm::dvec2(x_m, y_m) * (slope / (size_.radius_m * r_m));
}

Interval CraterShape::bounds_m(const Rect& rect) const {
  const Interval r_m = radii_of(rect);
  const Interval ratio{r_m.low / size_.radius_m, r_m.high / size_.radius_m};
  if (ratio.low >= size_.ejecta_ratio) return {0, 0};
  // The bowl ascends, peak and ejecta descend.
  const Interval outer{ejecta_m(std::max(ratio.high, 1.0)), ejecta_m(std::max(ratio.low, 1.0))};
  Interval all = outer;
  if (ratio.low < 1) {
    const double end = std::min(ratio.high, 1.0);
    const Interval inner{bowl_m(ratio.low) + peak_m(end), bowl_m(end) + peak_m(ratio.low)};
    all = ratio.high < 1 ? inner : hull(inner, outer);
  }
  return widened(all, kRounding * (size_.depth_m + size_.rim_m + size_.peak_m));
}

}  // namespace relief
