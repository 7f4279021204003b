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

// Returns a map of the same directions with few pixels.
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

std::optional<double> nearest_ground_m(const PanoramaRequest& request, double radius_m,
                                       core::DrawRequest draw_request, core::Renderer& renderer) {
  const panorama::PanoramaMap map = coarse_map(request.map);
  const panorama::Viewpoint middle = panorama::viewpoint_of(request.camera, radius_m);
  draw_request.want_range = true;
  draw_request.settings.samples = 1;
  std::optional<double> nearest_m;
  for (const panorama::Strip& strip : panorama::strips_of(map)) {
    for (const panorama::Piece& piece : panorama::pieces_of(map, middle, strip, 0)) {
      InterruptGuard::check();
      draw_request.view = piece.view;
      const core::DrawResult drawn = renderer.draw(draw_request);
      if (request.stereo->carried_gap_px && drawn.shows_see_through) {
        throw UsageError(
            "--stereo-method reproject: pixels of semi-transparent objects show several ranges and are not carried; "
            "use --stereo-method full");
      }
      if (const auto base_m = core::comfortable_base_m(drawn.frame.range_m))
        nearest_m = std::min(nearest_m.value_or(HUGE_VAL), *base_m * core::kNearestToBase);
    }
  }
  return nearest_m;
}

}  // namespace

void check_stereo_panorama(const PanoramaRequest& request) {
  if (!request.stereo) return;
  if (request.backend != core::Backend::kRay) {
    throw UsageError(
        "--stereo: triangles are drawn in planes, but every column of a panorama for two eyes has eyes of its "
        "own; leave out --backend " +
        std::string(core::to_string(request.backend)));
  }
  if (request.map.kind == MapKind::kFacets) {
    throw UsageError(
        "--stereo: a facet has one eye, but every column of a panorama for two eyes has eyes of its own; use "
        "--projection cylinder or equirectangular");
  }
  if (request.stereo->carried_gap_px && !core::has_one_ray_a_pixel(request.settings.values())) {
    throw UsageError(
        "--stereo-method reproject: images with several samples a pixel (samples, rays.vertical) are not carried; use "
        "--stereo-method full");
  }
  if (!request.layers.empty()) {
    throw UsageError(
        "--aux-layers and --stereo: auxiliary layers belong to one eye; make them with a panorama without "
        "--stereo, from the middle between both eyes");
  }
}

panorama::EyePair measure_eyes(const PanoramaRequest& request, double radius_m,
                               const core::DrawRequest& draw_request, core::Renderer& renderer) {
  panorama::EyePair eyes = request.stereo.value();
  eyes.nearest_m = nearest_ground_m(request, radius_m, draw_request, renderer);
  if (eyes.base_m <= 0 && !eyes.nearest_m) {
    throw std::runtime_error(
        "--stereo: the panorama shows sky alone; give the distance between the eyes with --eye-base");
  }
  if (eyes.base_m <= 0) eyes.base_m = *eyes.nearest_m / core::kNearestToBase;
  if (const std::string trouble = panorama::check(eyes); !trouble.empty())
    throw std::runtime_error("--eye-base: " + trouble);
  return eyes;
}

void require_eyes_above_ground(const PanoramaRequest& request, const paging::Surface& surface,
                               double clearance_m) {
  mars::Pose north = request.camera;
  north.yaw_deg = north.pitch_deg = north.roll_deg = 0.0;
  const mars::CameraPose middle = mars::to_camera(north, surface.planet_radius_m());
  const double base_m = request.stereo.value().base_m;
  for (int n = 0; n < kAzimuths; ++n) {
    // The left eye of an azimuth is the right one of the opposite azimuth.
    const double azimuth_deg = 360.0 * n / kAzimuths;
    const glm::dvec2 place_m = panorama::eye_place_m(panorama::Eye::kRight, azimuth_deg, base_m);
    const glm::dvec3 right_eye_m =
        middle.position_m + place_m.x * middle.axes.right + place_m.y * middle.axes.forward;
    const double above_m =
        glm::length(right_eye_m) - surface.at(right_eye_m, request.settings.values().exaggeration).radius_m;
    if (above_m >= clearance_m) continue;
    throw std::runtime_error("--stereo: with eyes " + base::format_rounded(base_m, 3) +
                             " m apart, the right eye of azimuth " + base::format_number(azimuth_deg) + " is " +
                             base::format_rounded(above_m, 3) +
                             " m above the ground; choose a smaller --eye-base or stand higher");
  }
}

}  // namespace vpe::app
