// Arithmetic of intervals and distances over rectangles, of which bounds of shapes are made.
//
// Distances are made of operations that round monotonically (differences, squares, sums, roots), so that an interval of
// distances over a rectangle holds the rounded distances of all its points.
#pragma once

#include "relief/shape.h"

namespace relief {

// Bounds the rounding of a shape's height relative to the sizes that it is made of. Bounds are wider by that much.
inline constexpr double kRounding = 1e-14;

// Returns the interval, longer by `by` at both ends.
Interval widened(const Interval& a, double by);

// Returns the interval of |x| for x of an interval.
Interval absolute(const Interval& a);

// Returns the plane as a rectangle.
Rect whole_plane();

// Returns the rectangle of the points with |x| <= half_x_m and |y| <= half_y_m.
Rect centred_rect(double half_x_m, double half_y_m);

// Returns the rectangle, longer by `by_m` on all sides.
Rect grown(const Rect& a, double by_m);

// Returns the common part of rectangles that overlap.
Rect intersection(const Rect& a, const Rect& b);

// Returns true if `inner` lies in `outer`.
bool contains(const Rect& outer, const Rect& inner);

// Returns true if the point lies in the rectangle.
bool contains(const Rect& rect, double x_m, double y_m);

// Return the distance of a point from the origin, and the interval of those of all points of a rectangle.
double radius_of(double x_m, double y_m);
Interval radii_of(const Rect& rect);

// Return the distance of a point from a box (0 in it), and the interval of those of all points of a rectangle.
double distance_of(const Rect& box, double x_m, double y_m);
Interval distances_of(const Rect& box, const Rect& rect);

// Returns the point of the box that is nearest to a point.
glm::dvec2 nearest_of(const Rect& box, double x_m, double y_m);

// Returns 3 t^2 - 2 t^3 for t clamped to [0, 1], and its derivative. It ascends but for rounding.
double smooth_step(double t);
double smooth_step_slope(double t);

}  // namespace relief
