// Volumes between triangles and a reference, as seen from the planet's centre.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>

#include "vpe/explore/drawing/ground_statistics.h"

namespace vpe::explore {

// Sums volumes triangle by triangle. Those that run clockwise, seen from outside, count negative.
//
// Typical usage:
//   VolumeSum sum([&](const glm::dvec3& d) { return plane_radius_m(d); }, true, radius_m);
//   for (const auto& triangle : triangles) sum.add(triangle);
class VolumeSum {
 public:
  // Returns the radius of the reference in the direction of a point.
  using Reference = std::function<double(const glm::dvec3& point_m)>;

  // A flat reference is a plane; another one is taken to be linear in radius over a triangle.
  VolumeSum(Reference reference, bool is_flat, double radius_m)
      : reference_(std::move(reference)), is_flat_(is_flat), radius_m_(radius_m) {}

  // Adds a triangle of the ground, metres from the planet's centre.
  void add(const std::array<glm::dvec3, 3>& corners_m);
  const GroundVolume& sum() const { return sum_; }

 private:
  void add_part(const std::array<glm::dvec3, 3>& corners_m, const std::array<double, 3>& reference_m,
                bool is_above);

  Reference reference_;
  bool is_flat_;
  double radius_m_;
  GroundVolume sum_;
};

// Returns the solid angle of a triangle of directions (of any length but 0), positive if it runs counterclockwise seen from
// outside (Van Oosterom and Strackee 1983). Pure.
double solid_angle(const std::array<glm::dvec3, 3>& corners);

}  // namespace vpe::explore
