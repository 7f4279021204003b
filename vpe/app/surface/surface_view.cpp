#include "vpe/app/surface/surface_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr double kViewMargin = 1.06;  // around a surface that is in the image as a whole
constexpr double kMostLon_deg = 360;
constexpr double kMostLat_deg = 90;

glm::dvec3 direction_of(const std::string& option, const std::string& text, double lon_deg, double lat_deg) {
  if (!(std::abs(lon_deg) <= kMostLon_deg && std::abs(lat_deg) <= kMostLat_deg))
    throw UsageError(option + " " + text +
                     ": expected a longitude of -360 to 360 and a latitude of -90 to 90 degrees");
  return mars::direction({lon_deg, lat_deg});
}

glm::dvec3 parse_point(const std::string& option, const std::string& text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 3) throw UsageError(option + " " + text + ": expected X,Y,Z in metres");
  const glm::dvec3 point_m{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  if (!(glm::length(point_m) <= core::ViewLimits::kMaxCameraDistance_m))
    throw UsageError(option + " " + text + ": farther than " +
                     base::format_number(core::ViewLimits::kMaxCameraDistance_m) + " m");
  return point_m;
}

mars::CameraPose looking(const glm::dvec3& camera_m, const glm::dvec3& target_m) {
  mars::CameraPose camera;
  camera.position_m = camera_m;
  const glm::dvec3 forward = glm::normalize(target_m - camera_m);
  constexpr double kAlongUp = 1e-6;
  glm::dvec3 right = glm::cross(forward, glm::dvec3(0, 0, 1));
  if (glm::length(right) < kAlongUp) right = glm::cross(forward, glm::dvec3(0, 1, 0));
  right = glm::normalize(right);
  camera.axes = {right, glm::cross(right, forward), forward};
  return camera;
}

}  // namespace

glm::dvec3 parse_direction(const std::string& option, const std::string& text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 2) throw UsageError(option + " " + text + ": expected LON,LAT in degrees");
  return direction_of(option, text, (*numbers)[0], (*numbers)[1]);
}

ParsedSurfaceView parse_surface_view(const SurfaceViewArguments& arguments) {
  if (!arguments.from.empty() && !arguments.camera.empty())
    throw UsageError("--from and --camera: give one of both, or none for a view of the whole surface");
  ParsedSurfaceView parsed;
  if (!arguments.from.empty()) {
    const auto numbers = parse_numbers(arguments.from);
    if (!numbers || numbers->size() < 2 || numbers->size() > 3)
      throw UsageError("--from " + arguments.from + ": expected LON,LAT or LON,LAT,RANGE");
    parsed.direction = direction_of("--from", arguments.from, (*numbers)[0], (*numbers)[1]);
    if (numbers->size() == 3) {
      if (!((*numbers)[2] > 0 && (*numbers)[2] <= core::ViewLimits::kMaxCameraDistance_m))
        throw UsageError("--from " + arguments.from + ": expected a RANGE above 0, in metres");
      parsed.range_m = (*numbers)[2];
    }
  }
  if (!arguments.camera.empty()) parsed.camera_m = parse_point("--camera", arguments.camera);
  if (!arguments.target.empty()) parsed.target_m = parse_point("--target", arguments.target);
  const Size size = parse_size(arguments.size);
  parsed.view.width = size.width;
  parsed.view.height = size.height;
  parsed.view.fov_deg = arguments.fov_deg;
  return parsed;
}

core::View resolve_view(const ParsedSurfaceView& parsed, const SurfaceScene& scene) {
  core::View view = parsed.view;
  const glm::dvec3 target_m = parsed.target_m.value_or(scene.middle_m);
  glm::dvec3 camera_m{0, 0, 0};
  if (parsed.camera_m) {
    camera_m = *parsed.camera_m;
  } else {
    const glm::dvec3 usual = mars::direction(scene.is_round ? mars::LonLat{0, 15} : mars::LonLat{-90, 35});
    const double half_rad = 0.5 * view.fov_deg * mars::kRadiansPerDegree;
    const double narrow_rad = std::min(half_rad, std::atan(std::tan(half_rad) * view.width / view.height));
    const double range_m = parsed.range_m.value_or(kViewMargin * scene.radius_m / std::sin(narrow_rad));
    camera_m = target_m + range_m * parsed.direction.value_or(usual);
  }
  if (camera_m == target_m)
    throw UsageError("--camera, --target: the camera is at its target, so that it looks nowhere");
  view.camera = looking(camera_m, target_m);
  if (const std::string problem = core::check(view); !problem.empty()) throw UsageError(problem);
  const double offset_m = scene.surface.offset_m(camera_m);
  if (offset_m < 0)
    throw std::runtime_error("the camera is " + length_text(-offset_m) +
                             " below the ground; give a larger RANGE of --from, or another --camera");
  return view;
}

}  // namespace vpe::app
