#include "vpe/explore/mouse.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/explore/orthographic.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

using mars::Pose;

constexpr double kKeepsHeading_deg = 80;  // up to this latitude

// Returns the point at which a line of sight meets a sphere about the planet's centre, or the nearest point of
// the sphere's visible edge if the line misses it.
glm::dvec3 on_ball(const glm::dvec3& camera_m, const glm::dvec3& ray, double radius_m) {
  const double middle_m = -glm::dot(camera_m, ray);
  const glm::dvec3 nearest = camera_m + ray * middle_m;
  const double off_m = glm::length(nearest);
  const double half2 = (radius_m - off_m) * (radius_m + off_m);
  const double inside = glm::length(camera_m) - radius_m;
  if (half2 >= 0.0) {
    const double half_m = std::sqrt(half2);
    if (inside < 0.0) return camera_m + ray * (middle_m + half_m);
    if (middle_m >= 0.0) return camera_m + ray * (middle_m - half_m);
  }
  // The visible edge is where a tangent through the camera, in the plane of the line of sight, touches the
  // sphere.
  const double distance_m = glm::length(camera_m);
  const glm::dvec3 up = camera_m / distance_m;
  const glm::dvec3 side = ray - up * glm::dot(ray, up);
  const double length = glm::length(side);
  if (length < 1e-12 || inside <= 0.0) return up * radius_m;
  const double c = std::min(1.0, radius_m / distance_m);
  return (up * c + side / length * std::sqrt((1.0 - c) * (1.0 + c))) * radius_m;
}

// Applies the smallest rotation that takes unit `from` to unit `to`.
glm::dvec3 rotate_vector(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double c = glm::dot(from, to);
  if (c < -0.999999) return v;  // opposite directions: no axis is better than another
  return v * c + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1.0 + c));
}

double distance_px(const Pose& pose, const Screen& screen, const glm::dvec3& point_m, glm::dvec2 xy,
                   double radius_m) {
  const core::Projected at = core::project(view_of(pose, screen, radius_m), point_m);
  return at.behind ? std::numeric_limits<double>::infinity() : glm::length(at.xy - xy);
}

// Moves the camera so that `held_m` comes to `xy`, from a pose near to that.
Pose moved_to_hold(const Pose& pose, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
                   double radius_m, bool keep_heading) {
  constexpr int kMostSteps = 40;
  constexpr double kNear_px = 1e-7;
  const double held_radius_m = glm::length(held_m);
  Pose at = pose;
  Pose best = pose;
  double best_px = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kMostSteps; ++n) {
    const core::View view = view_of(at, screen, radius_m);
    const glm::dvec3 shown = on_ball(view.camera.position_m, core::pixel_ray(view, xy.x, xy.y), held_radius_m);
    const glm::dvec3 from = glm::normalize(shown);
    const glm::dvec3 to = held_m / held_radius_m;
    mars::CameraPose camera = view.camera;
    camera.position_m = rotate_vector(camera.position_m, from, to);
    for (glm::dvec3* axis : {&camera.axes.right, &camera.axes.up, &camera.axes.forward})
      *axis = rotate_vector(*axis, from, to);
    const Pose found = mars::to_pose(camera, radius_m);
    Pose next = pose;
    next.lon_deg = found.lon_deg;
    next.lat_deg = found.lat_deg;
    if (!keep_heading) {
      next.yaw_deg = found.yaw_deg;
      // Straight up and down, yaw and roll rotate about one axis, so only their sum is meaningful.
      if (pose.pitch_deg < -89.999) next.yaw_deg += found.roll_deg - pose.roll_deg;
      if (pose.pitch_deg > 89.999) next.yaw_deg -= found.roll_deg - pose.roll_deg;
    }
    at = next;
    const double off_px = distance_px(at, screen, held_m, xy, radius_m);
    if (off_px < best_px) {
      best = at;
      best_px = off_px;
    }
    if (off_px < kNear_px || !keep_heading) break;
  }
  return best;
}

Pose held_under(const Pose& pose, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
                double radius_m) {
  const Pose free = moved_to_hold(pose, screen, held_m, xy, radius_m, false);
  if (std::abs(pose.lat_deg) > kKeepsHeading_deg || std::abs(free.lat_deg) > kKeepsHeading_deg) return free;
  const Pose kept = moved_to_hold(pose, screen, held_m, xy, radius_m, true);
  const double free_px = distance_px(free, screen, held_m, xy, radius_m);
  const double kept_px = distance_px(kept, screen, held_m, xy, radius_m);
  return kept_px <= free_px + 0.5 ? kept : free;
}

glm::dvec2 middle(const Screen& screen) { return {screen.width / 2.0, screen.height / 2.0}; }

}  // namespace

core::View view_of(const Pose& pose, const Screen& screen, double radius_m) {
  core::View view;
  view.camera = mars::to_camera(pose, radius_m);
  view.width = screen.width;
  view.height = screen.height;
  view.fov_deg = screen.fov_deg;
  return view;
}

std::optional<glm::dvec3> ground_at(const Pose& pose, const Screen& screen, glm::dvec2 xy,
                                    const TerrainQuery& ground) {
  const core::View view = view_of(pose, screen, ground.radius_m);
  const glm::dvec3 ray = core::pixel_ray(view, xy.x, xy.y);
  const double range_m = ground.cast_m(view.camera.position_m, ray);
  if (!std::isfinite(range_m)) return std::nullopt;
  return view.camera.position_m + ray * range_m;
}

Pose dragged(const Pose& begun, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
             const TerrainQuery& ground) {
  return kept_clear(held_under(begun, screen, held_m, xy, ground.radius_m), ground);
}

Pose panned(const Pose& begun, const Screen& screen, glm::dvec2 from, glm::dvec2 to) {
  const double focal = screen.height / 2.0 / std::tan(screen.fov_deg / 2.0 * mars::kRadiansPerDegree);
  const auto angle = [focal](double offset_px) {
    return std::atan2(offset_px, focal) / mars::kRadiansPerDegree;
  };
  const glm::dvec2 m = middle(screen);
  const double level = std::max(0.05, std::cos(begun.pitch_deg * mars::kRadiansPerDegree));
  return rotated(begun, -(angle(to.x - m.x) - angle(from.x - m.x)) / level,
                 angle(to.y - m.y) - angle(from.y - m.y), 0.0);
}

Pose zoomed(const Pose& pose, const Screen& screen, glm::dvec2 xy, double factor, const TerrainQuery& ground) {
  if (!(factor > 0.0) || !std::isfinite(factor)) return pose;
  const double f = std::clamp(factor, 0.1, 10.0);
  const std::optional<glm::dvec3> point = ground_at(pose, screen, xy, ground);
  Pose next = pose;
  if (!point) {
    const double height_m = std::max(height_above_ground_m(pose, ground), SteerLimits::kClearance_m);
    next.alt_m += height_m * (f - 1.0);
    return kept_clear(next, ground);
  }
  const mars::CameraPose camera = mars::to_camera(pose, ground.radius_m);
  const glm::dvec3 away = camera.position_m - *point;
  const double distance_m = glm::length(away);
  const double goal_m = std::max(distance_m * f, std::min(distance_m, MouseLimits::kNearest_m));
  const glm::dvec3 there = *point + away * (goal_m / std::max(distance_m, 1e-9));
  const mars::LonLat place = mars::lon_lat(there);
  next.lon_deg = place.lon_deg;
  next.lat_deg = place.lat_deg;
  next.alt_m = std::min(glm::length(there) - ground.radius_m, ground.highest_radii * ground.radius_m);
  return kept_clear(held_under(next, screen, *point, xy, ground.radius_m), ground);
}

Pose tilted(const Pose& pose, const Screen& screen, double around_deg, double up_deg,
            const TerrainQuery& ground) {
  if (!(std::isfinite(around_deg) && std::isfinite(up_deg))) return pose;
  const std::optional<glm::dvec3> pivot = ground_at(pose, screen, middle(screen), ground);
  if (!pivot) return kept_clear(rotated(pose, around_deg, -up_deg, 0.0), ground);
  const mars::CameraPose camera = mars::to_camera(pose, ground.radius_m);
  const glm::dvec3 away = camera.position_m - *pivot;
  const double distance_m = glm::length(away);
  // Azimuth and elevation of the camera in the pivot's level frame.
  const mars::LocalFrame frame = mars::local_frame(mars::lon_lat(*pivot));
  const glm::dvec3 out = away / std::max(distance_m, 1e-9);
  const double elevation_deg =
      std::asin(std::clamp(glm::dot(out, frame.up), -1.0, 1.0)) / mars::kRadiansPerDegree;
  // The heading towards the pivot by the camera's axes, which is defined straight above it too.
  const Pose local = mars::to_pose({frame.up * ground.radius_m, camera.axes}, ground.radius_m);
  const double heading_deg = local.yaw_deg + (local.pitch_deg < -89.9 ? local.roll_deg : 0.0) + around_deg;
  const double lowest_deg = std::min(elevation_deg, MouseLimits::kLowestTilt_deg);
  const double next_deg = std::clamp(elevation_deg + up_deg, lowest_deg, 90.0);
  const mars::SinCos h = mars::sin_cos_deg(heading_deg);
  const mars::SinCos e = mars::sin_cos_deg(next_deg);
  const glm::dvec3 ahead = frame.north * h.cos + frame.east * h.sin;
  mars::CameraPose next;
  next.position_m = *pivot + (frame.up * e.sin - ahead * e.cos) * distance_m;
  next.axes = mars::oriented_axes(frame, heading_deg, -next_deg, 0.0);
  Pose result = mars::to_pose(next, ground.radius_m);
  if (std::abs(local.pitch_deg) < 89.9) result.roll_deg = pose.roll_deg;
  return kept_clear(result, ground);
}

Pose looking_at(const Pose& pose, const glm::dvec3& point_m, double distance_m, const TerrainQuery& ground) {
  const mars::LonLat place = mars::lon_lat(point_m);
  const mars::LocalFrame frame = mars::local_frame(place);
  const double down_deg = std::clamp(-pose.pitch_deg, 20.0, 90.0);
  const mars::SinCos h = mars::sin_cos_deg(pose.yaw_deg);
  const mars::SinCos e = mars::sin_cos_deg(down_deg);
  const glm::dvec3 ahead = frame.north * h.cos + frame.east * h.sin;
  mars::CameraPose next;
  next.position_m =
      point_m + (frame.up * e.sin - ahead * e.cos) * std::max(distance_m, MouseLimits::kNearest_m);
  next.axes = mars::oriented_axes(frame, pose.yaw_deg, -down_deg, 0.0);
  return kept_clear(mars::to_pose(next, ground.radius_m), ground);
}

Pose overview(mars::LonLat place, const Screen& screen, double radius_m) {
  const double vertical_rad = screen.fov_deg / 2.0 * mars::kRadiansPerDegree;
  const double horizontal_rad = std::atan(std::tan(vertical_rad) * screen.width / screen.height);
  const double half_rad = std::min(vertical_rad, horizontal_rad) * 0.9;
  Pose pose{place.lon_deg, place.lat_deg, 0, 0, -90, 0};
  pose.alt_m = std::min(radius_m / std::sin(half_rad) - radius_m, highest_radii(screen.fov_deg) * radius_m);
  return pose;
}

}  // namespace vpe::explore
