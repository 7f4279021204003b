// A relief at its place on a planet's sphere.
//
// Frame: the shape's plane touches the sphere at the place. Its x axis has the azimuth of the relief, its y axis lies 90
// degrees to the left of it. A direction at the angle a from the place has the distance radius * a from the origin and keeps
// its bearing (azimuthal equidistant projection): distances from the place are exact, lengths across them are too long in
// the plane by the factor a / sin(a), 1 + a^2 / 6. That is 0.014 % 100 km from the place on Mars.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "mars/sources/source.h"
#include "relief/composition.h"
#include "relief/shape.h"
#include "relief/spec.h"

namespace relief {

// Bounds the angle from the place to the end of a relief.
inline constexpr double kMostReach_rad = 1;

// The shapes of a relief in its plane. They may be shared with other threads and outlive the relief.
struct ReliefShapes {
  std::shared_ptr<const Shape> height;  // above the shape's zero
  std::shared_ptr<const Shape> weight;  // nullptr: 1 everywhere, the height ends by itself
  double reach_m = 0;                   // from the origin to the end of both
  double part_m = 0;                    // size of the smallest part
};

// Holds what a relief did to ground at one place.
struct ReliefChange {
  double height_m = 0;
  bool is_changed = false;  // the height is another
  bool decides = false;     // it changed the height with a weight above 1/2
};

// Immutable: any number of threads may use it.
class PlacedRelief {
 public:
  // Places a relief without a problem_of() on a sphere of radius_m; its zero is that of a level of 0 until set_zero_m().
  // Throws std::invalid_argument if it reaches further than kMostReach_rad.
  PlacedRelief(ReliefSpec spec, double radius_m);

  const ReliefSpec& spec() const { return spec_; }
  const ReliefShapes& shapes() const { return shapes_; }
  Mode mode() const { return mode_; }
  // Returns the height of the shape's zero above the datum; 0 for Mode::kAdd, which counts from the ground.
  double zero_m() const { return zero_m_; }
  // Returns true if the zero counts from the ground at the place.
  bool needs_ground() const;
  void set_zero_m(double zero_m) { zero_m_ = zero_m; }
  // Returns the places that it may change.
  const mars::Cap& cap() const { return cap_; }
  // Returns the wanted distance of posts.
  double spacing_m() const;

  // Returns the place of a direction within kMostReach_rad in the plane.
  glm::dvec2 local_m(const glm::dvec3& direction) const;

  // Returns the ground at a unit direction after the change. NaN stays NaN.
  ReliefChange change(const glm::dvec3& direction, double ground_m) const;

  // Returns true if a place of the cap may be changed.
  bool touches(const mars::Cap& cap) const;

  // Returns an interval that holds the changed heights in a cap whose ground has the heights of an interval.
  Interval bounds_m(const mars::Cap& cap, const Interval& ground_m) const;

 private:
  Rect local_rect(const mars::Cap& cap) const;
  double stretch_m(double sine, double cosine) const;

  ReliefSpec spec_;
  double radius_m_;
  Mode mode_;
  glm::dvec3 axis_x_;
  glm::dvec3 axis_y_;
  ReliefShapes shapes_;
  Rect support_;
  mars::Cap cap_;
  double sine_of_reach_ = 0;
  double zero_m_ = 0;
};

// Returns the shapes of a relief without a problem_of(). `corners_m` is its polygon in its plane.
ReliefShapes shapes_of(const ReliefSpec& spec, std::vector<glm::dvec2> corners_m);

}  // namespace relief
