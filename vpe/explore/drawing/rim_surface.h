// A smooth surface that goes through the heights of a closed outline, as ground without what lies within.
//
// Typical usage:
//   const RimSurface rim(outline, heights_m);
//   const double depth_m = rim.at(place) - ground_m;
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vpe::explore {

// Interpolates by mean value coordinates (Floater 2003, Computer Aided Geometric Design 20): linear functions come back,
// values stay between the lowest and the highest of the outline where it is convex, and the surface has no bulges. Values
// within are taken from a lattice of kCells cells a side, between which it is bilinear.
class RimSurface {
 public:
  static constexpr int kCells = 128;

  // Takes the corners of an outline that does not cross itself, in order, in any plane coordinates, and their heights.
  // Throws std::invalid_argument for fewer than three corners, unequal numbers, or an outline without extent.
  RimSurface(std::span<const glm::dvec2> outline, std::span<const double> heights_m);

  // Returns the height at a place; places beyond the outline's extent get that of the nearest in it. Pure.
  double at(const glm::dvec2& place) const;

 private:
  glm::dvec2 low_;
  glm::dvec2 size_;
  std::vector<double> heights_m_;  // of the lattice, row by row
};

// Returns the height at one place by mean value coordinates. Pure.
double mean_value_height(std::span<const glm::dvec2> outline, std::span<const double> heights_m,
                         const glm::dvec2& place);

}  // namespace vpe::explore
