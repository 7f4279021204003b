// Weights: shapes with heights from 0 to 1 that say how much of a place another shape decides (relief/composition.h).
//
// Each is 1 in its inner part and falls to 0 by a smooth step over `falloff_m`, which must be above 0. Their gradients
// are continuous, except beside corners and the middle lines of polygons. Lengths must be finite.
#pragma once

#include <vector>

#include "relief/shape.h"

namespace relief {

// Is 1 up to radius_m >= 0 around the origin and 0 from radius_m + falloff_m on.
class CircleWeight final : public Shape {
 public:
  CircleWeight(double radius_m, double falloff_m) : radius_m_(radius_m), falloff_m_(falloff_m) {}

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double at(double r_m) const;

  double radius_m_;
  double falloff_m_;
};

// Is 1 in a box and 0 at distances of falloff_m and more from it.
class BoxWeight final : public Shape {
 public:
  BoxWeight(const Rect& box, double falloff_m) : box_(box), falloff_m_(falloff_m) {}

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double at(double distance_m) const;

  Rect box_;
  double falloff_m_;
};

// Is 0 outside of a polygon and on its border, and 1 at distances of falloff_m and more from the border inside. Points
// are inside where a line to infinity crosses the border an odd number of times. Bounds come from the distance at the
// centre of the rectangle, which changes by at most the way.
class PolygonWeight final : public Shape {
 public:
  // Expects at least 3 corners.
  PolygonWeight(std::vector<glm::dvec2> corners_m, double falloff_m);

  Rect support() const override { return support_; }
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  struct Border {
    double distance_m;  // above 0 inside, below 0 outside
    glm::dvec2 nearest_m;
  };
  Border border(double x_m, double y_m) const;

  std::vector<glm::dvec2> corners_m_;
  double falloff_m_;
  Rect support_;
};

}  // namespace relief
