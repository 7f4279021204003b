#include "vpe/explore/drawing/ground_volume.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::explore {

namespace {

double sixth_of_box(const std::array<glm::dvec3, 3>& t) {
  // About a corner, so that thin triangles far from the centre keep their digits.
  return glm::dot(t[0], glm::cross(t[1] - t[0], t[2] - t[0])) / 6;
}

}  // namespace

double solid_angle(const std::array<glm::dvec3, 3>& corners) {
  const glm::dvec3 lengths{glm::length(corners[0]), glm::length(corners[1]), glm::length(corners[2])};
  // The box is that of the volume, so that rounding of corners cancels in the difference of two cones.
  return 2 * std::atan2(6 * sixth_of_box(corners), lengths.x * lengths.y * lengths.z +
                                                       glm::dot(corners[0], corners[1]) * lengths.z +
                                                       glm::dot(corners[1], corners[2]) * lengths.x +
                                                       glm::dot(corners[2], corners[0]) * lengths.y);
}

void VolumeSum::add_part(const std::array<glm::dvec3, 3>& corners_m, const std::array<double, 3>& reference_m,
                         bool is_above) {
  const double angle = solid_angle(corners_m);
  double volume_m3 = 0;
  if (is_flat_) {
    // The difference of two cones; each corner's factor is near 1.
    const glm::dvec3 lengths{glm::length(corners_m[0]), glm::length(corners_m[1]), glm::length(corners_m[2])};
    const double kept =
        reference_m[0] / lengths.x * (reference_m[1] / lengths.y) * (reference_m[2] / lengths.z);
    volume_m3 = sixth_of_box(corners_m) * (1 - kept);
  } else {
    const double base_m = (reference_m[0] + reference_m[1] + reference_m[2]) / 3;
    // The cone of the ground less that of the reference at its mean radius: both are large, so the ground is
    // measured from the sphere of that radius.
    const double ground_m3 = sixth_of_box(corners_m);
    double of_reference = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const double off = reference_m[n] - base_m;
      for (std::size_t k = n; k < 3; ++k) of_reference += off * (reference_m[k] - base_m) / 6;
    }
    // The mean of the cube of a linear function, to the second order.
    volume_m3 = ground_m3 - angle * (base_m * base_m * base_m + 3 * base_m * of_reference) / 3;
  }
  const double area_m2 = angle * radius_m_ * radius_m_;
  if (is_above) {
    sum_.above_m3 += volume_m3;
    sum_.area_above_m2 += area_m2;
  } else {
    sum_.below_m3 -= volume_m3;
    sum_.area_below_m2 += area_m2;
  }
}

void VolumeSum::add(const std::array<glm::dvec3, 3>& corners_m) {
  std::array<double, 3> reference_m{};
  std::array<double, 3> above_m{};
  for (std::size_t n = 0; n < 3; ++n) {
    reference_m[n] = reference_(corners_m[n]);
    above_m[n] = glm::length(corners_m[n]) - reference_m[n];
  }
  const auto is_above = [&](std::size_t n) { return above_m[n] >= 0; };
  if (is_above(0) == is_above(1) && is_above(1) == is_above(2))
    return add_part(corners_m, reference_m, is_above(0));
  // One corner is on the other side than both others.
  const std::size_t alone = is_above(0) == is_above(1) ? 2 : is_above(0) == is_above(2) ? 1 : 0;
  const std::size_t next = (alone + 1) % 3;
  const std::size_t last = (alone + 2) % 3;
  const auto crossing = [&](std::size_t to) {
    double share = above_m[alone] / (above_m[alone] - above_m[to]);
    if (is_flat_) {
      // The distance from the plane n.p = c is linear along the edge. It is c times this quotient.
      const double at_alone = above_m[alone] / reference_m[alone];
      const double at_to = above_m[to] / reference_m[to];
      share = at_alone / (at_alone - at_to);
    }
    return share;
  };
  const double to_next = crossing(next);
  const double to_last = crossing(last);
  const glm::dvec3 on_next = corners_m[alone] + to_next * (corners_m[next] - corners_m[alone]);
  const glm::dvec3 on_last = corners_m[alone] + to_last * (corners_m[last] - corners_m[alone]);
  const auto reference_at = [&](const glm::dvec3& point_m, std::size_t to, double share) {
    return is_flat_ ? glm::length(point_m)
                    : reference_m[alone] + share * (reference_m[to] - reference_m[alone]);
  };
  const double r_next = reference_at(on_next, next, to_next);
  const double r_last = reference_at(on_last, last, to_last);
  add_part({corners_m[alone], on_next, on_last}, {reference_m[alone], r_next, r_last}, is_above(alone));
  add_part({on_next, corners_m[next], corners_m[last]}, {r_next, reference_m[next], reference_m[last]},
           is_above(next));
  add_part({on_next, corners_m[last], on_last}, {r_next, reference_m[last], r_last}, is_above(next));
}

}  // namespace vpe::explore
