#include "vpe/app/panorama/panorama_stereo.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vpe/app/cli/interrupt.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using panorama::MapKind;

constexpr double kCoarse_deg = 0.35;
constexpr double kLeastColumns = 16;
constexpr int kAzimuths = 720;

// The same directions in few pixels.
panorama::PanoramaMap coarse_map(const panorama::PlanOptions& options) {
  const panorama::PanoramaMap map = panorama::plan_panorama(options).map;
  const double height_deg = map.to_direction(0.5, 0.0).elevation_deg -
                            map.to_direction(0.5, static_cast<double>(map.height_px)).elevation_deg;
  const double coarse_deg =
      std::min({kCoarse_deg, map.azimuth_span_deg() / kLeastColumns, height_deg / kLeastColumns});
  panorama::PlanOptions coarse = options;
  coarse.width_px.reset();
  coarse.degrees_per_pixel = std::max(coarse_deg, 360.0 / map.turn_px);
  return panorama::plan_panorama(coarse).map;
}

std::optional<double> nearest_ground_m(const PanoramaRecipe& recipe, double radius_m, core::DrawRequest request,
                                       core::Renderer& renderer) {
  const panorama::PanoramaMap map = coarse_map(recipe.plan);
  request.want_range = true;
  request.settings.samples = 1;
  std::optional<double> nearest_m;
  for (const panorama::Strip& strip : panorama::strips_of(map)) {
    for (const panorama::Piece& piece : panorama::pieces_of(map, {recipe.camera, radius_m}, strip, 0)) {
      InterruptGuard::check();
      request.view = piece.view;
      const auto base_m = core::comfortable_base_m(renderer.draw(request).frame.range_m);
      if (base_m) nearest_m = std::min(nearest_m.value_or(HUGE_VAL), *base_m * core::kNearestToBase);
    }
  }
  return nearest_m;
}

}  // namespace

void check_stereo_panorama(const StereoArguments& arguments, const PanoramaRecipe& recipe) {
  check_stereo(arguments);
  if (arguments.layout.empty() && !recipe.stereo) return;
  if (recipe.backend != "voxel") {
    throw UsageError(
        "--stereo: triangles are drawn in planes, but every column of a panorama for two eyes has eyes of its "
        "own; "
        "leave out --backend " +
        recipe.backend);
  }
  if (recipe.plan.kind == MapKind::kFacets) {
    throw UsageError(
        "--stereo: a facet has one eye, but every column of a panorama for two eyes has eyes of its own; use "
        "--projection cylinder or equirectangular");
  }
  if (!recipe.planes.empty()) {
    throw UsageError(
        "--planes and --stereo: planes are of one eye; draw them with a panorama without --stereo, from the "
        "middle between both");
  }
}

panorama::EyePair measure_eyes(const StereoArguments& arguments, const PanoramaRecipe& recipe, double radius_m,
                               const core::DrawRequest& request, core::Renderer& renderer) {
  panorama::EyePair eyes;
  eyes.layout = *core::parse_stereo(arguments.layout);
  eyes.nearest_m = nearest_ground_m(recipe, radius_m, request, renderer);
  if (arguments.eye_base_m <= 0 && !eyes.nearest_m) {
    throw std::runtime_error(
        "--stereo: the panorama shows sky alone; say how far apart the eyes are with --eye-base");
  }
  eyes.base_m = arguments.eye_base_m > 0 ? arguments.eye_base_m : *eyes.nearest_m / core::kNearestToBase;
  if (const std::string trouble = panorama::check(eyes); !trouble.empty())
    throw std::runtime_error("--eye-base: " + trouble);
  return eyes;
}

void require_eyes_above_ground(const PanoramaRecipe& recipe, const paging::Surface& surface,
                               double clearance_m) {
  mars::Pose north = recipe.camera;
  north.yaw_deg = north.pitch_deg = north.roll_deg = 0.0;
  const mars::CameraPose middle = mars::to_camera(north, surface.planet_radius_m());
  const double base_m = recipe.stereo->base_m;
  for (int n = 0; n < kAzimuths; ++n) {
    // The left eye of an azimuth is the right one of the opposite.
    const double azimuth_deg = 360.0 * n / kAzimuths;
    const glm::dvec2 place_m = panorama::eye_place_m(panorama::Eye::kRight, azimuth_deg, base_m);
    const glm::dvec3 camera_m =
        middle.position_m + place_m.x * middle.axes.right + place_m.y * middle.axes.forward;
    const double above_m =
        glm::length(camera_m) - surface.at(camera_m, recipe.settings.values().exaggeration).radius_m;
    if (above_m >= clearance_m) continue;
    throw std::runtime_error("--stereo: with eyes " + base::format_number(std::round(1e3 * base_m) / 1e3) +
                             " m apart, the right eye of azimuth " + base::format_number(azimuth_deg) + " is " +
                             base::format_number(std::round(1e3 * above_m) / 1e3) +
                             " m above the ground; choose a smaller --eye-base or stand higher");
  }
}

}  // namespace vpe::app
