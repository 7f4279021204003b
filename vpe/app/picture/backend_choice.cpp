#include "vpe/app/picture/backend_choice.h"

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "vpe/base/number.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::app {

namespace {

void set(core::Settings& settings, const char* key, const std::string& text) {
  if (const std::string error = settings.set(key, text); !error.empty()) throw std::logic_error(error);
}

core::Settings within_tolerance(core::Settings settings, const RenderOptions& options) {
  const bool is_named = std::any_of(options.set.begin(), options.set.end(), [](const std::string& text) {
    return text.starts_with("rays.") && !text.starts_with("rays.fovea");
  });
  const double tolerance_px = settings.values().lod_tolerance_px;
  if (is_named || tolerance_px < core::RayLimits::kLeastCell_px) return settings;
  set(settings, "rays.mode", "multires");
  set(settings, "rays.cell", base::format_number(std::min(tolerance_px, core::RayLimits::kMostCell_px)));
  return settings;
}

}  // namespace

bool suits_rays(const core::DrawRequest& request) {
  const core::SettingsValues& values = request.settings;
  const core::SettingsValues defaults;
  return voxel::why_not(request).empty() && values.shading == defaults.shading;
}

namespace {

core::DrawRequest with_rays_of(core::DrawRequest request, const core::Settings& settings) {
  request.settings.ray_mode = settings.values().ray_mode;
  request.settings.ray_cell_px = settings.values().ray_cell_px;
  return request;
}

}  // namespace

BackendChoice choose_backend(const RenderOptions& options, const core::Settings& settings,
                             std::span<const core::DrawRequest> images, double radius_m, bool has_gpu) {
  if (options.backend) return {*options.backend, settings};
  // No other backend has it.
  const core::RayMode mode = settings.values().ray_mode;
  if (mode == core::RayMode::kPerturbation || mode == core::RayMode::kDiscrete || voxel::is_volume_mode(mode))
    return {core::Backend::kRay, settings};
  const auto for_rays = std::count_if(images.begin(), images.end(), [&](const core::DrawRequest& request) {
    return glm::length(request.view.camera.position_m) < (1 + core::kRaysReach_radii) * radius_m &&
           core::reaches_horizon(request.view, radius_m);
  });
  const core::Settings for_ray_images = within_tolerance(settings, options);
  const bool is_rays = !has_gpu && 2 * static_cast<std::size_t>(for_rays) >= images.size() &&
                       std::all_of(images.begin(), images.end(), [&](const core::DrawRequest& request) {
                         return suits_rays(with_rays_of(request, for_ray_images));
                       });
  if (!is_rays) return {core::Backend::kPolygon, settings};
  return {core::Backend::kRay, for_ray_images};
}

std::optional<BackendChoice> rays_instead(const RenderOptions& options, const core::Settings& settings,
                                          std::span<const core::DrawRequest> images) {
  const core::Settings for_ray_images = within_tolerance(settings, options);
  const bool suits = std::all_of(images.begin(), images.end(), [&](const core::DrawRequest& request) {
    return voxel::why_not(with_rays_of(request, for_ray_images)).empty();
  });
  if (!suits) return std::nullopt;
  return BackendChoice{core::Backend::kRay, for_ray_images};
}

void note_rays_instead(const std::string& reason, bool quiet) {
  if (!quiet) std::fprintf(stderr, "vpe: note: drawn by rays, as there is no OpenGL: %s\n", reason.c_str());
}

}  // namespace vpe::app
