#include "panorama/match/photo_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace panorama {

namespace {

const mars::LocalFrame kLevelFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

mars::Axes axes_of(const PhotoPose& pose) {
  return mars::oriented_axes(kLevelFrame, pose.yaw_deg, pose.pitch_deg, pose.roll_deg);
}

double focal_of(const PhotoShape& shape, double fov_deg) {
  return 0.5 * shape.height_px / std::tan(0.5 * fov_deg * mars::kRadiansPerDegree);
}

glm::dvec3 vector_of(const Direction& d) {
  const double a = d.azimuth_deg * mars::kRadiansPerDegree;
  const double e = d.elevation_deg * mars::kRadiansPerDegree;
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

}  // namespace

double pixels_per_radian(const PhotoShape& shape, double fov_deg) {
  return shape.map ? shape.map->turn_px / (2 * std::numbers::pi) : focal_of(shape, fov_deg);
}

glm::dvec3 camera_ray(const PhotoShape& shape, double fov_deg, double x_px, double y_px) {
  if (shape.map) return vector_of(shape.map->to_direction(x_px, y_px));
  return glm::normalize(
      glm::dvec3(x_px - 0.5 * shape.width_px, 0.5 * shape.height_px - y_px, focal_of(shape, fov_deg)));
}

DirectionFinder::DirectionFinder(const PhotoShape& shape, const PhotoPose& pose)
    : shape_(shape), fov_deg_(pose.fov_deg), axes_(axes_of(pose)) {}

Direction DirectionFinder::at(double x_px, double y_px) const {
  const glm::dvec3 ray = camera_ray(shape_, fov_deg_, x_px, y_px);
  const glm::dvec3 v = ray.x * axes_.right + ray.y * axes_.up + ray.z * axes_.forward;
  return {std::atan2(v.x, v.y) / mars::kRadiansPerDegree,
          std::atan2(v.z, std::hypot(v.x, v.y)) / mars::kRadiansPerDegree};
}

std::optional<glm::dvec2> photo_place(const PhotoShape& shape, const PhotoPose& pose,
                                      const Direction& direction) {
  const mars::Axes axes = axes_of(pose);
  const glm::dvec3 v = vector_of(direction);
  const glm::dvec3 world(v.x, v.z, v.y);
  const glm::dvec3 ray(glm::dot(world, axes.right), glm::dot(world, axes.up), glm::dot(world, axes.forward));
  if (!shape.map) {
    constexpr double kLeastDepth = 1e-6;
    if (ray.z < kLeastDepth) return std::nullopt;
    const double f = focal_of(shape, pose.fov_deg);
    return glm::dvec2(0.5 * shape.width_px + f * ray.x / ray.z, 0.5 * shape.height_px - f * ray.y / ray.z);
  }
  const Direction seen{std::atan2(ray.x, ray.z) / mars::kRadiansPerDegree,
                       std::atan2(ray.y, std::hypot(ray.x, ray.z)) / mars::kRadiansPerDegree};
  constexpr double kNearPole_deg = 89;
  if (std::abs(seen.elevation_deg) > kNearPole_deg) return std::nullopt;
  return shape.map->place(seen);
}

}  // namespace panorama
