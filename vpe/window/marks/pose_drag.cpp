#include "vpe/window/marks/pose_drag.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace vpe::window {

namespace {

// Returns the point of a sphere about the centre on a ray from `from_m`, the one nearer to `near_m`, or nullopt where
// the ray grazes the sphere or misses it.
std::optional<glm::dvec3> on_level(const glm::dvec3& from_m, const glm::dvec3& ray, double radius_m,
                                   const glm::dvec3& near_m) {
  const double along_m = -glm::dot(from_m, ray);
  const double half_m = std::sqrt(
      std::max(0.0, along_m * along_m - (glm::length(from_m) - radius_m) * (glm::length(from_m) + radius_m)));
  if (half_m < radius_m * std::sin(PoseDragLimits::kGrazing_deg * mars::kRadiansPerDegree)) return std::nullopt;
  std::optional<glm::dvec3> best;
  for (const double range_m : {along_m - half_m, along_m + half_m}) {
    const glm::dvec3 point_m = from_m + range_m * ray;
    if (range_m > 0 && (!best || glm::length(point_m - near_m) < glm::length(*best - near_m))) best = point_m;
  }
  return best;
}

mars::LonLat turned(const glm::dvec3& camera_m, const glm::dvec3& ray, mars::LonLat from) {
  const glm::dvec3 up = glm::normalize(camera_m);
  const glm::dvec3 level = ray - glm::dot(ray, up) * up;
  if (glm::length(level) < 1e-9) return from;
  const double angle_rad = mars::angle_between_rad(up, mars::direction(from));
  return mars::lon_lat(std::cos(angle_rad) * up + std::sin(angle_rad) * glm::normalize(level));
}

}  // namespace

mars::LonLat dragged_pose(const core::View& view, mars::LonLat from, glm::dvec2 xy,
                          const std::function<double(mars::LonLat)>& radius_m) {
  const glm::dvec3& camera_m = view.camera.position_m;
  const glm::dvec3 ray = core::pixel_ray(view, xy.x, xy.y);
  double level_m = radius_m(from);
  const glm::dvec3 before_m = mars::direction(from) * level_m;
  mars::LonLat place = from;
  for (int n = 0; n < PoseDragLimits::kMostSteps; ++n) {
    const std::optional<glm::dvec3> point_m = on_level(camera_m, ray, level_m, before_m);
    if (!point_m) return turned(camera_m, ray, from);
    place = mars::lon_lat(*point_m);
    const double next_m = radius_m(place);
    if (std::abs(next_m - level_m) < PoseDragLimits::kReached_m) break;
    level_m = next_m;
  }
  return place;
}

}  // namespace vpe::window
