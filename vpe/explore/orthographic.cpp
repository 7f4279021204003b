#include "vpe/explore/orthographic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kUsualFov_deg = 50;

double tangent_of_half_view(double fov_deg) { return std::tan(0.5 * fov_deg * mars::kRadiansPerDegree); }

}  // namespace

double highest_radii(double fov_deg) {
  if (!is_orthographic(fov_deg)) return SteerLimits::kHighest_radii;
  return SteerLimits::kHighest_radii * tangent_of_half_view(kUsualFov_deg) / tangent_of_half_view(fov_deg);
}

std::optional<mars::Pose> at_same_size(const mars::Pose& pose, const Screen& screen, double fov_deg,
                                       const TerrainQuery& ground) {
  const auto middle = ground_at(pose, screen, {screen.width / 2.0, screen.height / 2.0}, ground);
  if (!middle) return std::nullopt;
  mars::CameraPose camera = mars::to_camera(pose, ground.radius_m);
  const double factor = tangent_of_half_view(screen.fov_deg) / tangent_of_half_view(fov_deg);
  camera.position_m = *middle + (camera.position_m - *middle) * factor;
  return mars::to_pose(camera, ground.radius_m);
}

std::optional<double> shown_height_m(const mars::Pose& pose, const Screen& screen, const TerrainQuery& ground) {
  const auto middle = ground_at(pose, screen, {screen.width / 2.0, screen.height / 2.0}, ground);
  if (!middle) return std::nullopt;
  const glm::dvec3 away = mars::to_camera(pose, ground.radius_m).position_m - *middle;
  return 2.0 * glm::length(away) * tangent_of_half_view(screen.fov_deg);
}

double parallel_shift_px(const Screen& screen, double shown_m, double depth_m) {
  const double distance_m = shown_m / (2.0 * tangent_of_half_view(screen.fov_deg));
  const double near_m = distance_m - std::abs(depth_m);
  if (!(near_m > 0)) return std::numeric_limits<double>::infinity();
  return 0.5 * std::hypot(screen.width, screen.height) * std::abs(depth_m) / near_m;
}

}  // namespace vpe::explore
