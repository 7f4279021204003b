#include "vpe/explore/steer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::explore {

namespace {

using mars::Pose;

constexpr int kMostSteps = 256;

double normalized(double angle_deg) {
  const double remainder_deg = std::remainder(angle_deg, 360.0);
  return remainder_deg <= -180.0 ? 180.0 : remainder_deg;
}

double ground_height_m(const Pose& pose, const TerrainQuery& ground) {
  return ground.height_m(mars::direction({pose.lon_deg, pose.lat_deg}));
}

// Moves along the great circle that begins with `heading_deg`, and rotates the camera with it.
Pose carried_by(const Pose& pose, double heading_deg, double arc_rad) {
  if (arc_rad == 0.0) return pose;
  // Transports directions, not bearings, which are undefined at a pole.
  const mars::LocalFrame frame = mars::local_frame({pose.lon_deg, pose.lat_deg});
  const mars::SinCos h = mars::sin_cos_deg(heading_deg);
  const glm::dvec3 ahead = frame.north * h.cos + frame.east * h.sin;
  const double c = std::cos(arc_rad);
  const double s = std::sin(arc_rad);
  const glm::dvec3 up = frame.up * c + ahead * s;
  const glm::dvec3 ahead_there = ahead * c - frame.up * s;
  const mars::LonLat place = mars::lon_lat(up);
  const mars::LocalFrame there = mars::local_frame(place);
  const double heading_there_deg =
      std::atan2(glm::dot(ahead_there, there.east), glm::dot(ahead_there, there.north)) /
      mars::kRadiansPerDegree;
  Pose next = pose;
  next.lon_deg = place.lon_deg;
  next.lat_deg = place.lat_deg;
  next.yaw_deg = normalized(pose.yaw_deg + (heading_there_deg - heading_deg));
  return next;
}

// Rotates the camera by the controls of a frame.
Pose aimed(const Pose& pose, const Controls& controls, double dt_s) {
  return rotated(pose, controls.yaw_right * SteerLimits::kRotation_deg_s * dt_s,
                 controls.pitch_up * SteerLimits::kRotation_deg_s * dt_s,
                 controls.roll_right * SteerLimits::kRoll_deg_s * dt_s);
}

bool moves(const Controls& controls) {
  return controls.right != 0 || controls.up != 0 || controls.forward != 0;
}

}  // namespace

double height_above_ground_m(const Pose& pose, const TerrainQuery& ground) {
  return pose.alt_m - ground_height_m(pose, ground);
}

double full_speed_m_s(const Pose& pose, const TerrainQuery& ground) {
  return std::max(SteerLimits::kSlowest_m_s, SteerLimits::kSpeed_per_s * height_above_ground_m(pose, ground));
}

Pose kept_clear(const Pose& pose, const TerrainQuery& ground, double clearance_m) {
  Pose clear = pose;
  clear.lon_deg = mars::normalize_lon_deg(pose.lon_deg);
  clear.pitch_deg = std::clamp(pose.pitch_deg, -90.0, 90.0);
  clear.yaw_deg = normalized(pose.yaw_deg);
  clear.roll_deg = normalized(pose.roll_deg);
  const double highest_m = ground.highest_radii * ground.radius_m;
  clear.alt_m =
      std::clamp(pose.alt_m, std::min(ground_height_m(pose, ground) + clearance_m, highest_m), highest_m);
  return clear;
}

Pose carried(const Pose& pose, double right_m, double forward_m, double radius_m) {
  const double way_m = std::hypot(right_m, forward_m);
  if (!std::isfinite(way_m)) return pose;
  const double heading_deg = pose.yaw_deg + std::atan2(right_m, forward_m) / mars::kRadiansPerDegree;
  return carried_by(pose, heading_deg, way_m / std::max(radius_m + pose.alt_m, 1.0));
}

Pose moved(const Pose& pose, double right_m, double up_m, double forward_m, const TerrainQuery& ground) {
  const double ahead_m = std::hypot(right_m, forward_m);
  if (!(std::isfinite(ahead_m) && std::isfinite(up_m))) return pose;
  const double heading_deg = pose.yaw_deg + std::atan2(right_m, forward_m) / mars::kRadiansPerDegree;
  // Obstacles are noticed if a step is not longer than the camera's height above the ground.
  const double height_m = std::max(height_above_ground_m(pose, ground), SteerLimits::kClearance_m);
  const int steps = std::clamp(static_cast<int>(std::ceil(4.0 * ahead_m / height_m)), 1, kMostSteps);
  Pose at = pose;
  double heading_now_deg = heading_deg;
  for (int n = 0; n < steps; ++n) {
    const double arc_rad = ahead_m / steps / std::max(ground.radius_m + at.alt_m, 1.0);
    const Pose next = carried_by(at, heading_now_deg, arc_rad);
    heading_now_deg += next.yaw_deg - at.yaw_deg;
    at = next;
    at.alt_m += up_m / steps;
    at = kept_clear(at, ground);
  }
  return at;
}

Pose rotated(const Pose& pose, double yaw_deg, double pitch_deg, double roll_deg) {
  if (!(std::isfinite(yaw_deg) && std::isfinite(pitch_deg) && std::isfinite(roll_deg))) return pose;
  Pose next = pose;
  next.yaw_deg = normalized(pose.yaw_deg + yaw_deg);
  next.pitch_deg = std::clamp(pose.pitch_deg + pitch_deg, -90.0, 90.0);
  next.roll_deg = normalized(pose.roll_deg + roll_deg);
  return next;
}

Pose steered(const Pose& pose, const Controls& controls, double dt_s, const TerrainQuery& ground) {
  if (!any(controls) || !(dt_s > 0.0)) return pose;
  const double dt = std::min(dt_s, SteerLimits::kLongestStep_s);
  const Pose from = aimed(pose, controls, dt);
  if (!moves(controls)) return from;
  const double step_m = full_speed_m_s(from, ground) * controls.speed * dt;
  // The camera's axes in its level frame: right, up, forward.
  const mars::LocalFrame level{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};  // east, north, up
  const mars::Axes axes = mars::oriented_axes(level, 0.0, from.pitch_deg, from.roll_deg);
  const glm::dvec3 step =
      (axes.right * controls.right + axes.up * controls.up + axes.forward * controls.forward) * step_m;
  return moved(from, step.x, step.y, step.z, ground);
}

Pose flown(const Pose& pose, const Controls& controls, double dt_s, const TerrainQuery& ground) {
  if (!any(controls) || !(dt_s > 0.0)) return pose;
  const double dt = std::min(dt_s, SteerLimits::kLongestStep_s);
  const Pose from = aimed(pose, controls, dt);
  if (!moves(controls)) return from;
  const double step_m = full_speed_m_s(from, ground) * controls.speed * dt;
  return moved(from, controls.right * step_m, controls.up * step_m, controls.forward * step_m, ground);
}

}  // namespace vpe::explore
