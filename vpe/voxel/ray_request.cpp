#include "vpe/voxel/ray_request.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "lod/options.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/voxel/cast/pixel_normal.h"

namespace vpe::voxel {

namespace {

VolumeForm volume_form(const core::SettingsValues& values) {
  VolumeForm form;
  switch (values.ray_volume_filter) {
    case core::RayVolumeFilter::kNone: form.band.filter = VolumeFilter::kNone; break;
    case core::RayVolumeFilter::kGaussian: form.band.filter = VolumeFilter::kGaussian; break;
    case core::RayVolumeFilter::kBox: form.band.filter = VolumeFilter::kBox; break;
  }
  form.interval = values.ray_volume_step;
  if (values.ray_volume_near_m) form.near_m = *values.ray_volume_near_m;
  if (values.ray_mode == core::RayMode::kBoundary) form.near_m = 0;
  return form;
}

// Returns true if pixels of the image may have the ranges of the nearest columns.
bool has_nearest(const core::DrawRequest& request) {
  const core::RayMode mode = request.settings.ray_mode;
  return request.view.projection == core::Projection::kPerspective &&
         (mode == core::RayMode::kExact || mode == core::RayMode::kMultires);
}

}  // namespace

bool is_volume_mode(core::RayMode mode) {
  return mode == core::RayMode::kVolume || mode == core::RayMode::kBoundary;
}

bool draws_ground_parts(const core::DrawRequest& request) {
  return is_volume_mode(request.settings.ray_mode) && request.coarsening <= 1;
}

RangeOptions for_hints(RangeOptions options, double downsampling) {
  // Volumes are made of the same tiles.
  if (options.method == RangeOptions::Method::kVolume) options.method = RangeOptions::Method::kColumns;
  options.discrete = {};
  options.sectors = {};
  options.cell_px /= downsampling;
  return options;
}

RangeOptions range_options(const core::DrawRequest& request, double planet_radius_m) {
  RangeOptions options;
  options.exaggeration = request.settings.exaggeration;
  if (request.settings.ray_mode == core::RayMode::kReference) options.method = RangeOptions::Method::kReference;
  if (request.settings.ray_mode == core::RayMode::kDiscrete) {
    options.method = RangeOptions::Method::kDiscrete;
    options.cell_px = request.settings.ray_ratio * std::max(1.0, request.coarsening);
    options.discrete = {request.settings.ray_columns, request.settings.ray_vertical,
                        request.settings.ray_blend};
    return options;
  }
  if (draws_ground_parts(request)) {
    options.method = RangeOptions::Method::kVolume;
    options.volume = volume_form(request.settings);
    options.volume.parts = request.ground_parts;
    return options;
  }
  // Coarsening, the price of speed, acts on the cells.
  if (request.settings.ray_mode == core::RayMode::kMultires || request.coarsening > 1)
    options.cell_px = request.settings.ray_cell_px * std::max(1.0, request.coarsening);
  if (options.method == RangeOptions::Method::kColumns)
    options.sectors = {takes_nearest(request), request.settings.ray_spacing_px};
  options.control = lod::level_control(request, planet_radius_m);
  return options;
}

bool takes_nearest(const core::DrawRequest& request) {
  const core::SettingsValues& values = request.settings;
  if (!has_nearest(request)) return false;
  return values.ray_sample == core::RaySample::kNearest ||
         (values.ray_sample == core::RaySample::kAuto && values.samples > 1 && request.want_colour);
}

double rise_px(double distance_px, double steepest_slope) {
  return distance_px * std::hypot(1.0, steepest_slope);
}

std::optional<SmoothForm> smooth_form(const core::DrawRequest& request) {
  if (request.settings.ray_mode != core::RayMode::kPerturbation || request.coarsening > 1) return std::nullopt;
  return SmoothForm{request.settings.ray_patch, request.settings.exaggeration};
}

std::size_t drawn_pixels(const core::View& view) {
  const glm::ivec2 size = core::drawn_size(view);
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

std::size_t ray_image_bytes(const core::DrawRequest& request) {
  // Colour, range and inverse depth, and copies while the image is smoothed and written.
  constexpr std::size_t kBytesPerPixel = 16;
  constexpr std::size_t kBytesPerSum = sizeof(glm::ivec3) + sizeof(float);
  constexpr std::size_t kBytesOfFovea = 8;  // the outer image has a quarter of the pixels
  const bool has_parts = request.ground_parts && draws_ground_parts(request);
  const bool has_normals = has_parts || request.settings.ray_mode == core::RayMode::kPerturbation;
  const bool is_discrete = request.settings.ray_mode == core::RayMode::kDiscrete;
  const std::size_t bytes_of_rays =
      is_discrete ? (static_cast<std::size_t>(request.settings.ray_vertical) + 1) * kBytesPerSum : 0;
  return drawn_pixels(request.view) *
         (kBytesPerPixel + (request.settings.samples > 1 ? kBytesPerSum : 0) + bytes_of_rays +
          (request.settings.ray_fovea ? kBytesOfFovea : 0) + (has_normals ? sizeof(PixelNormal) : 0));
}

std::string why_not(const core::DrawRequest& request) {
  const core::Mode mode = request.settings.mode;
  if (mode == core::Mode::kWireframe || mode == core::Mode::kMarkers)
    return "the ray backend has no triangles to show: use --backend polygon for this mode";
  if (request.settings.shading == core::Shading::kVertex)
    return "the ray backend has no triangles to light: use --backend polygon for shading=vertex";
  const core::Inspect inspect = request.settings.inspect;
  if (request.cull_view || inspect == core::Inspect::kBorders || inspect == core::Inspect::kLevels)
    return "the ray backend draws no tiles: --cull-from, inspect=borders and inspect=levels show those of --backend "
           "polygon";
  if (const std::string_view control = refused_control(request); !control.empty())
    return "the ray backend draws no triangles: " + std::string(control) + " acts with --backend polygon only";
  if (const std::string_view control = multires_control(request);
      !control.empty() && request.settings.ray_mode != core::RayMode::kMultires)
    return "the ray backend chooses tiles without level control in this rays.mode: " + std::string(control) +
           " acts with --set rays.mode=multires, or with --backend polygon";
  if (request.settings.ray_mode == core::RayMode::kDiscrete) {
    if (!casts_by_columns(request.view))
      return "rays.mode=discrete casts vertical columns: perspective images, and panoramas of a level camera; use another "
             "rays.mode";
    if (request.settings.samples > 1)
      return "rays.mode=discrete has its own rays in a pixel: set rays.vertical, and leave out samples";
    if (request.settings.ray_columns == core::RayColumns::kLines) {
      if (request.view.projection != core::Projection::kPerspective)
        return "rays.columns=lines is for perspective images: use --set rays.columns=sectors";
      if (request.settings.ray_vertical > 1)
        return "rays.columns=lines has one ray in a pixel: set rays.vertical=1, or rays.columns=sectors";
    }
  }
  if (request.settings.ray_sample == core::RaySample::kNearest && !has_nearest(request))
    return request.view.projection == core::Projection::kPerspective
               ? "rays.sample=nearest is for rays.mode=exact and multires: take one of them, or set rays.sample=auto"
               : "rays.sample=nearest is for perspective images, as pixels of a panorama have columns of their own: set "
                 "rays.sample=auto";
  if (request.settings.ray_fovea) {
    if (request.settings.ray_mode != core::RayMode::kMultires)
      return "rays.fovea thins the rays of rays.mode=multires only: add --set rays.mode=multires, or set "
             "rays.fovea=off";
    if (request.view.projection != core::Projection::kPerspective)
      return "rays.fovea thins perspective images only, as a panorama has no middle: set rays.fovea=off";
  }
  return {};
}

std::string_view refused_control(const core::DrawRequest& request) {
  return request.settings.lod_triangles != 0 ? "lod.triangles" : "";
}

std::string_view multires_control(const core::DrawRequest& request) {
  const core::SettingsValues& values = request.settings;
  if (values.lod_centre_weight != 0) return "lod.centre.weight";
  if (values.lod_metric != core::SettingsValues().lod_metric) return "lod.metric=distance";
  if (!request.interest.empty() && values.lod_interest_weight != 0)
    return "level control by regions of interest";
  if (values.degrade_distance != 1) return "degrade.distance";
  if (values.degrade_centre != 1) return "degrade.centre";
  if (values.degrade_interest != 1) return "degrade.interest";
  return {};
}

}  // namespace vpe::voxel
