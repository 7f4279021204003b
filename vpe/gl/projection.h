// From camera coordinates to clip coordinates.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include "vpe/core/view.h"

namespace vpe::gl {

// Describes clip = (scale.x e.x + shift.x e.z, scale.y e.y + shift.y e.z, near, -e.z) for a point e right, up
// and backward of the camera. Depth is near / distance along the view axis: 1 at the near plane, 0 at infinity.
struct ClipProjection {
  float near_m = 1;
  glm::vec4 scale_shift{1, 1, 0, 0};
};

// Returns the projection of a perspective view, of its part if it has one. near_m > 0.
ClipProjection clip_projection(const core::View& view, double near_m);

// Returns the rotation from body-fixed axes to right, up, backward.
glm::mat3 body_to_camera(const mars::Axes& axes);

}  // namespace vpe::gl
