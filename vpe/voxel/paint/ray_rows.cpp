#include "vpe/voxel/paint/ray_rows.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::voxel {

RayRows ray_rows(const core::View& view) {
  const core::SubRectangle part = core::drawn_part(view);
  const mars::Axes& axes = view.camera.axes;
  const double focal = core::focal_px(view);
  const double centre_x = 0.5 * view.width + view.principal_offset_px.x;
  const double centre_y = 0.5 * view.height + view.principal_offset_px.y;
  const bool perspective = view.projection == core::Projection::kPerspective;
  const bool cylinder = view.projection == core::Projection::kCylinder;

  RayRows out;
  const int padded = (part.width + kBlock - 1) / kBlock * kBlock;
  for (int n = 0; n < padded; ++n) {
    const double x = part.x + std::min(n, part.width - 1) + 0.5 - centre_x;
    if (perspective) {
      out.c0.push_back(x / focal);
      out.c1.push_back(0);
      continue;
    }
    const mars::SinCos azimuth = mars::sin_cos_deg(std::remainder(x, view.width) * 360.0 / view.width);
    out.c0.push_back(azimuth.sin);
    out.c1.push_back(azimuth.cos);
  }
  for (int n = 0; n < part.height; ++n) {
    const double y = centre_y - (part.y + n + 0.5);
    RowRays& row = out.rows.emplace_back();
    if (perspective) {
      row.a = axes.right;
      row.b = glm::dvec3(0);
      row.c = axes.up * (y / focal) + axes.forward;
      row.m0 = glm::dot(row.c, row.c);
      row.m1 = 2 * glm::dot(row.a, row.c);
      row.m2 = glm::dot(row.a, row.a);
      continue;
    }
    const mars::SinCos elevation =
        cylinder ? mars::SinCos{y / focal, 1} : mars::sin_cos_deg(y * view.fov_deg / view.height);
    row.a = axes.right * elevation.cos;
    row.b = axes.forward * elevation.cos;
    row.c = axes.up * elevation.sin;
    row.m0 = elevation.sin * elevation.sin + elevation.cos * elevation.cos;
  }
  return out;
}

}  // namespace vpe::voxel
