// Rays and views for tests of casters, and the check of a hit by sampling.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "relief/cast/caster.h"
#include "vpe/core/view.h"

namespace relief::rays {

inline vpe::core::View look(const glm::dvec3& from_m, const glm::dvec3& at_m, int width, int height,
                            double fov_deg) {
  vpe::core::View view;
  view.camera.position_m = from_m;
  const glm::dvec3 forward = glm::normalize(at_m - from_m);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.01, 0.02, 1)));
  view.camera.axes = {right, glm::cross(right, forward), forward};
  view.width = width;
  view.height = height;
  view.fov_deg = fov_deg;
  return view;
}

inline glm::dvec3 pixel_direction(const vpe::core::View& view, std::size_t n) {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  const std::size_t width = static_cast<std::size_t>(part.width);
  return vpe::core::pixel_ray(view, part.x + static_cast<double>(n % width) + 0.5,
                              part.y + static_cast<double>(n / width) + 0.5);
}

// Expects that a hit lies on the ground within `slack_m`, and that no sample in front of it lies on the other side of the
// ground than the camera by more than that.
inline void expect_first(const Surface& surface, const glm::dvec3& from, const glm::dvec3& d, double hit,
                         double far_m, double slack_m) {
  const double end = std::min(hit, far_m);
  if (hit < kNoHit) {
    const double offset = surface.offset_m(from + hit * d);
    if (!std::isnan(offset)) {
      EXPECT_LE(std::abs(offset), slack_m) << "at " << hit;
    }
  }
  double sign = 0;
  for (int n = 0; n <= 2000; ++n) {
    const double offset = surface.offset_m(from + (end * n / 2000) * d);
    if (std::isnan(offset) || std::abs(offset) <= slack_m) continue;
    if (sign == 0) sign = offset > 0 ? 1 : -1;
    ASSERT_GT(offset * sign, 0) << "at " << end * n / 2000 << " before " << hit;
  }
}

}  // namespace relief::rays
