#include "vpe/app/picture/contour_ranges.h"

#include <algorithm>

namespace vpe::app {

double shift_px(const core::Certificate& certificate) {
  return certificate.image_bound_px.value_or(certificate.shift_bound_px);
}

std::optional<core::DrawRequest> contour_request(const core::DrawRequest& request,
                                                 const core::DrawResult& drawn) {
  const double tolerance_px = request.settings.contour_tolerance_px;
  const core::Certificate& c = drawn.certificate;
  if (!request.settings.contours || c.is_below_ground) return std::nullopt;
  // The error of storage and arithmetic stays whatever is drawn.
  constexpr double kRounding_px = 1e-9;
  if (shift_px(c) - c.quantisation_px <= tolerance_px + kRounding_px) return std::nullopt;
  core::DrawRequest finer = request;
  core::SettingsValues& settings = finer.settings;
  const core::SettingsValues usual;
  settings.lod_tolerance_px = tolerance_px;
  settings.lod_triangles = usual.lod_triangles;
  settings.lod_metric = usual.lod_metric;
  settings.lod_centre_weight = usual.lod_centre_weight;
  settings.degrade_distance = usual.degrade_distance;
  settings.degrade_centre = usual.degrade_centre;
  settings.degrade_interest = usual.degrade_interest;
  finer.interest.clear();
  finer.coarsening = 1;
  const bool has_cells = tolerance_px >= core::RayLimits::kLeastCell_px;
  settings.ray_mode = has_cells ? core::RayMode::kMultires : core::RayMode::kExact;
  settings.ray_fovea = usual.ray_fovea;
  settings.ray_sample = core::RaySample::kPixel;
  settings.ray_spacing_px = usual.ray_spacing_px;
  settings.ray_cell_px = std::min(tolerance_px, core::RayLimits::kMostCell_px);
  finer.want_range = true;
  finer.want_colour = false;
  return finer;
}

}  // namespace vpe::app
