#include "cull/frustum.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace cull {

Frustum make_frustum(const vpe::core::View& view) {
  Frustum frustum;
  frustum.camera_m = view.camera.position_m;
  if (view.projection != vpe::core::Projection::kPerspective) return frustum;
  frustum.normals[0] = view.camera.axes.forward;
  const std::array<vpe::core::Plane, 4> sides = vpe::core::side_planes(view);
  for (std::size_t k = 0; k < sides.size(); ++k) frustum.normals[k + 1] = sides[k].normal;
  frustum.count = 5;
  return frustum;
}

PlaneMask all_planes(const Frustum& frustum) { return static_cast<PlaneMask>((1 << frustum.count) - 1); }

std::optional<PlaneMask> planes_crossed(const Frustum& frustum, const BoundingHexahedron& volume,
                                        PlaneMask mask) {
  if (mask == 0) return mask;
  std::array<glm::dvec3, 8> corners;
  double largest = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    corners[k] = volume.corners_m[k] - frustum.camera_m;
    largest = std::max({largest, std::abs(corners[k].x), std::abs(corners[k].y), std::abs(corners[k].z)});
  }
  const auto reach = [](const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  // Covers the rounding of the corners, the camera, the differences and the products.
  const double slack = 4.0 * kVolumeError * (reach(frustum.camera_m) + largest);
  PlaneMask crossed = 0;
  for (std::size_t plane = 0; plane < static_cast<std::size_t>(frustum.count); ++plane) {
    if ((mask >> plane & 1) == 0) continue;
    double low = glm::dot(frustum.normals[plane], corners[0]);
    double high = low;
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const double side = glm::dot(frustum.normals[plane], corners[k]);
      low = std::min(low, side);
      high = std::max(high, side);
    }
    if (high < -slack) return std::nullopt;
    if (low < slack) crossed = static_cast<PlaneMask>(crossed | (1 << plane));
  }
  return crossed;
}

}  // namespace cull
