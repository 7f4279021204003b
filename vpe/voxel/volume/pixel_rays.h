// Rays through the centres of the pixels of a perspective view, one after the other.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "vpe/core/view.h"

namespace vpe::voxel {

// Holds what all pixels of a whole perspective image have in common. A pure value.
class PixelRays {
 public:
  explicit PixelRays(const core::View& view)
      : right_(view.camera.axes.right),
        down_(-view.camera.axes.up),
        first_(view.camera.axes.forward * core::focal_px(view) +
               right_ * (0.5 - 0.5 * view.width - view.principal_offset_px.x) +
               down_ * (0.5 - 0.5 * view.height - view.principal_offset_px.y)) {}

  // Returns the unit direction through the centre of pixel (x, y): core::pixel_ray() within 1e-14.
  glm::dvec3 through(int x, int y) const {
    const glm::dvec3 d = first_ + right_ * static_cast<double>(x) + down_ * static_cast<double>(y);
    return d / glm::length(d);
  }

 private:
  glm::dvec3 right_;
  glm::dvec3 down_;
  glm::dvec3 first_;
};

}  // namespace vpe::voxel
