#include "vpe/explore/wheel_zoom.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

using mars::Pose;

double blended_angle(double from_deg, double to_deg, double share) {
  return from_deg + std::remainder(to_deg - from_deg, 360.0) * share;
}

glm::dvec3 position_m(const Pose& pose, double radius_m) {
  return mars::direction({pose.lon_deg, pose.lat_deg}) * (radius_m + pose.alt_m);
}

}  // namespace

double arrival_pitch_deg(double distance_m) {
  const double from = std::log(WheelLimits::kArrivalFrom_m);
  const double to = std::log(WheelLimits::kArrivalTo_m);
  const double u = std::clamp((from - std::log(std::max(distance_m, 1e-3))) / (from - to), 0.0, 1.0);
  return -90.0 + (WheelLimits::kArrivalPitch_deg + 90.0) * u * u * (3.0 - 2.0 * u);
}

Pose pitched_about(const Pose& pose, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
                   double pitch_deg, const TerrainQuery& ground) {
  const mars::CameraPose camera = mars::to_camera(pose, ground.radius_m);
  const glm::dvec3 axis = camera.axes.right;
  const glm::dvec3 away = camera.position_m - held_m;
  const mars::SinCos turn = mars::sin_cos_deg(pitch_deg - pose.pitch_deg);
  const glm::dvec3 rotated_m =
      away * turn.cos + glm::cross(axis, away) * turn.sin + axis * (glm::dot(axis, away) * (1.0 - turn.cos));
  const glm::dvec3 there_m = held_m + rotated_m;
  const mars::LonLat place = mars::lon_lat(there_m);
  Pose next = pose;
  next.lon_deg = place.lon_deg;
  next.lat_deg = place.lat_deg;
  next.alt_m = glm::length(there_m) - ground.radius_m;
  next.pitch_deg = pitch_deg;
  return dragged(next, screen, held_m, xy, ground);
}

Pose pose_at(const WheelMotion& motion, double time_s, const TerrainQuery& ground) {
  if (!(time_s < WheelLimits::kTime_s)) return motion.to;
  const double left = 1.0 - std::max(time_s, 0.0) / WheelLimits::kTime_s;
  const double s = 1.0 - left * left * left;
  const glm::dvec3 from_m = position_m(motion.from, ground.radius_m);
  const glm::dvec3 to_m = position_m(motion.to, ground.radius_m);
  Pose pose = motion.from;
  glm::dvec3 at_m = from_m + (to_m - from_m) * s;
  if (motion.held_m) {
    const glm::dvec3 from_away = from_m - *motion.held_m;
    const glm::dvec3 to_away = to_m - *motion.held_m;
    const double from_distance_m = glm::length(from_away);
    const double to_distance_m = glm::length(to_away);
    if (from_distance_m > 0 && to_distance_m > 0) {
      const glm::dvec3 out = from_away / from_distance_m * (1.0 - s) + to_away / to_distance_m * s;
      const double distance_m = from_distance_m * std::pow(to_distance_m / from_distance_m, s);
      if (glm::length(out) > 1e-6) at_m = *motion.held_m + glm::normalize(out) * distance_m;
    }
  }
  const mars::LonLat place = mars::lon_lat(at_m);
  pose.lon_deg = place.lon_deg;
  pose.lat_deg = place.lat_deg;
  pose.alt_m = glm::length(at_m) - ground.radius_m;
  pose.yaw_deg = blended_angle(motion.from.yaw_deg, motion.to.yaw_deg, s);
  pose.pitch_deg = motion.from.pitch_deg + (motion.to.pitch_deg - motion.from.pitch_deg) * s;
  pose.roll_deg = blended_angle(motion.from.roll_deg, motion.to.roll_deg, s);
  return kept_clear(pose, ground);
}

}  // namespace vpe::explore
