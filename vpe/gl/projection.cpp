#include "vpe/gl/projection.h"

namespace vpe::gl {

ClipProjection clip_projection(const core::View& view, double near_m) {
  const double f = core::focal_px(view);
  const glm::ivec2 size = core::drawn_size(view);
  const double x = 0.5 * view.width + view.principal_offset_px.x - view.part.x;
  const double y = 0.5 * view.height + view.principal_offset_px.y - view.part.y;
  return {static_cast<float>(near_m),
          glm::vec4(2.0 * f / size.x, 2.0 * f / size.y, 1.0 - 2.0 * x / size.x, 2.0 * y / size.y - 1.0)};
}

glm::mat3 body_to_camera(const mars::Axes& axes) {
  const glm::dvec3 back = -axes.forward;
  return glm::mat3(glm::vec3(axes.right.x, axes.up.x, back.x), glm::vec3(axes.right.y, axes.up.y, back.y),
                   glm::vec3(axes.right.z, axes.up.z, back.z));
}

}  // namespace vpe::gl
