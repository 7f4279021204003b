#include "lod/off_axis_magnification.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace lod {

ImagePlane image_plane(const vpe::core::View& view) {
  ImagePlane plane;
  plane.flat = view.projection == vpe::core::Projection::kPerspective;
  if (!plane.flat) return plane;
  const double f = vpe::core::focal_px(view);
  const glm::ivec2 size = vpe::core::drawn_size(view);
  const double left = view.part.x - 0.5 * view.width - view.principal_offset_px.x;
  const double top = 0.5 * view.height + view.principal_offset_px.y - view.part.y;
  plane.camera_m = view.camera.position_m;
  plane.right = view.camera.axes.right;
  plane.up = view.camera.axes.up;
  plane.forward = view.camera.axes.forward;
  plane.low = {left / f, (top - size.y) / f};
  plane.high = {(left + size.x) / f, top / f};
  return plane;
}

// At image tangents t and depth z a displacement e n moves the point by e / z (n.xy - t n.z), with n in the
// image's axes. The length is convex in t, so over a rectangle it is largest in a corner; it changes by at most
// sec(t) times the angle by which n changes.
double off_axis_magnification(const ImagePlane& plane, const cull::BoundingHexahedron& volume) {
  if (!plane.flat) return 1.0;
  // The rectangle of the image in which the volume can be.
  constexpr double kFar = std::numeric_limits<double>::infinity();
  glm::dvec2 low(kFar);
  glm::dvec2 high(-kFar);
  for (const glm::dvec3& corner : volume.corners_m) {
    const glm::dvec3 p = corner - plane.camera_m;
    const double z = glm::dot(p, plane.forward);
    if (!(z > 1e-3 * glm::length(p))) {
      low = glm::dvec2(-kFar);
      high = glm::dvec2(kFar);
      break;
    }
    const glm::dvec2 t(glm::dot(p, plane.right) / z, glm::dot(p, plane.up) / z);
    low = glm::min(low, t);
    high = glm::max(high, t);
  }
  low = glm::clamp(low, plane.low, plane.high);
  high = glm::clamp(high, plane.low, plane.high);

  const glm::dvec3 n(glm::dot(volume.centre, plane.right), glm::dot(volume.centre, plane.up),
                     glm::dot(volume.centre, plane.forward));
  double turn = 0;
  for (std::size_t k = 4; k < 8; ++k) {
    const double cosine = glm::dot(volume.centre, volume.corners_m[k]) / glm::length(volume.corners_m[k]);
    turn = std::max(turn, std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine)));
  }
  double secant = 1.0;
  double length = 0.0;
  for (const double a : {low.x, high.x}) {
    for (const double b : {low.y, high.y}) {
      const double s = std::sqrt(1.0 + a * a + b * b);
      secant = std::max(secant, s);
      length = std::max(length, std::hypot(n.x - a * n.z, n.y - b * n.z) + turn * s);
    }
  }
  return std::max(1.0, secant * std::min(secant, length));
}

}  // namespace lod
