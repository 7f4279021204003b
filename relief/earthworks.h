// Shapes of earthworks: levels, ramps, trenches, dams. All lengths and angles must be finite.
#pragma once

#include "relief/shape.h"

namespace relief {

// Has one height everywhere. Its support is the plane.
class LevelShape final : public Shape {
 public:
  explicit LevelShape(double level_m) : level_m_(level_m) {}

  Rect support() const override;
  double height_m(double, double) const override { return level_m_; }
  glm::dvec2 gradient(double, double) const override { return {0, 0}; }
  Interval bounds_m(const Rect&) const override { return {level_m_, level_m_}; }

 private:
  double level_m_;
};

// Rises along x from start_m to end_m within length_m > 0 around the origin, and is level beyond. Its support is the
// plane.
class RampShape final : public Shape {
 public:
  RampShape(double length_m, double start_m, double end_m)
      : length_m_(length_m), start_m_(start_m), end_m_(end_m) {}

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double length_m_;
  double start_m_;
  double end_m_;
};

// Lies depth_m >= 0 below 0 on a floor of length_m along x and width_m along y. Around the floor it rises with the slope
// of slope_deg, above 0 and below 90, to 0; corners are rounded.
class TrenchShape final : public Shape {
 public:
  TrenchShape(double length_m, double width_m, double depth_m, double slope_deg);

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double at(double distance_m) const;

  Rect floor_;
  double depth_m_;
  double slope_;    // rise by run
  double reach_m_;  // from the floor to the edge
};

// Has its crest at height_m, of length_m along x and width_m along y. Around the crest it falls with the slope of
// slope_deg, above 0 and below 90, without end: the ground ends it (Mode::kMax). Its support is the plane.
class DamShape final : public Shape {
 public:
  DamShape(double length_m, double width_m, double height_m, double slope_deg);

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double at(double distance_m) const { return height_m_ - slope_ * distance_m; }

  Rect crest_;
  double height_m_;
  double slope_;  // rise by run
};

// Returns rise by run of a slope.
double slope_of(double slope_deg);

}  // namespace relief
