#include "relief/earthworks.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "relief/interval_math.h"

namespace relief {

namespace {

// Returns the direction that leads away from a box, of length 1; 0 in the box.
glm::dvec2 away_from(const Rect& box, double x_m, double y_m) {
  const double distance_m = distance_of(box, x_m, y_m);
  if (!(distance_m > 0)) return {0, 0};
  return (glm::dvec2(x_m, y_m) - nearest_of(box, x_m, y_m)) / distance_m;
}

}  // namespace

double slope_of(double slope_deg) {
  const mars::SinCos slope = mars::sin_cos_deg(slope_deg);
  return slope.sin / slope.cos;
}

Rect LevelShape::support() const { return whole_plane(); }

Rect RampShape::support() const { return whole_plane(); }

double RampShape::height_m(double x_m, double) const {
  return start_m_ + (end_m_ - start_m_) * std::clamp(x_m / length_m_ + 0.5, 0.0, 1.0);
}

glm::dvec2 RampShape::gradient(double x_m, double) const {
  return {std::abs(x_m) < length_m_ / 2 ? (end_m_ - start_m_) / length_m_ : 0.0, 0};
}

Interval RampShape::bounds_m(const Rect& rect) const {
  const double at0_m = height_m(rect.x0_m, 0);
  const double at1_m = height_m(rect.x1_m, 0);
  return widened({std::min(at0_m, at1_m), std::max(at0_m, at1_m)},
                 kRounding * (std::abs(start_m_) + std::abs(end_m_)));
}

TrenchShape::TrenchShape(double length_m, double width_m, double depth_m, double slope_deg)
    : floor_(centred_rect(length_m / 2, width_m / 2)),
      depth_m_(depth_m),
      slope_(slope_of(slope_deg)),
      reach_m_(depth_m_ / slope_) {}

double TrenchShape::at(double distance_m) const {
  return distance_m >= reach_m_ ? 0.0 : std::min(0.0, slope_ * distance_m - depth_m_);
}

Rect TrenchShape::support() const { return grown(floor_, reach_m_); }

double TrenchShape::height_m(double x_m, double y_m) const { return at(distance_of(floor_, x_m, y_m)); }

glm::dvec2 TrenchShape::gradient(double x_m, double y_m) const {
  if (distance_of(floor_, x_m, y_m) >= reach_m_) return {0, 0};
  return slope_ * away_from(floor_, x_m, y_m);
}

Interval TrenchShape::bounds_m(const Rect& rect) const {
  const Interval distance_m = distances_of(floor_, rect);
  const Interval found{at(distance_m.low), at(distance_m.high)};
  // The lowest and the highest heights are exact.
  return {std::max(found.low - kRounding * depth_m_, -depth_m_),
          std::min(found.high + kRounding * depth_m_, 0.0)};
}

DamShape::DamShape(double length_m, double width_m, double height_m, double slope_deg)
    : crest_(centred_rect(length_m / 2, width_m / 2)), height_m_(height_m), slope_(slope_of(slope_deg)) {}

Rect DamShape::support() const { return whole_plane(); }

double DamShape::height_m(double x_m, double y_m) const { return at(distance_of(crest_, x_m, y_m)); }

glm::dvec2 DamShape::gradient(double x_m, double y_m) const { return -slope_ * away_from(crest_, x_m, y_m); }

Interval DamShape::bounds_m(const Rect& rect) const {
  const Interval distance_m = distances_of(crest_, rect);
  return {at(distance_m.high), at(distance_m.low)};
}

}  // namespace relief
