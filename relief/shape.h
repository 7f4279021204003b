// Shapes of relief: scalar functions over a plane that perturb a base surface.
//
// A shape gives heights over its own plane, with bounds over rectangles and gradients. Vyatkin and Dolgovesov 2002
// (section 2) call it a perturbation function: the surface F(p) = 0 becomes F(p) + R(p) = 0.
#pragma once

#include <glm/vec2.hpp>

namespace relief {

// Holds the numbers from `low` to `high`, both included; low <= high.
struct Interval {
  double low = 0;
  double high = 0;
};

// Holds a rectangle of a shape's plane in metres, borders included.
struct Rect {
  double x0_m = 0;
  double y0_m = 0;
  double x1_m = 0;
  double y1_m = 0;
};

// Return the smallest interval that holds both, and that of all sums of a number of each.
Interval hull(const Interval& a, const Interval& b);
Interval sum(const Interval& a, const Interval& b);

// Returns true if the rectangles have a point in common.
bool overlap(const Rect& a, const Rect& b);

// Gives heights over a plane. Every const member may be called from any number of threads at once, and is a pure
// function of its arguments.
class Shape {
 public:
  virtual ~Shape() = default;

  // Returns the rectangle outside of which the height is 0. It may be infinite.
  virtual Rect support() const = 0;

  // Returns the height at a point in metres; 0 outside of the support. It is continuous in the plane.
  virtual double height_m(double x_m, double y_m) const = 0;

  // Returns the derivatives of the height by x and by y. At a crease it returns those of one side.
  virtual glm::dvec2 gradient(double x_m, double y_m) const = 0;

  // Returns an interval that holds the heights of all points of a rectangle. It shrinks to the height as the
  // rectangle shrinks to a point.
  virtual Interval bounds_m(const Rect& rect) const = 0;
};

}  // namespace relief
