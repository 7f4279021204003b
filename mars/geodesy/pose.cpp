#include "mars/geodesy/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace mars {

namespace {

// Rotates the perpendicular unit vectors `from` and `to` in their plane, `from` towards `to`.
void rotate(glm::dvec3& from, glm::dvec3& to, SinCos angle) {
  const glm::dvec3 rotated = from * angle.cos + to * angle.sin;
  to = to * angle.cos - from * angle.sin;
  from = rotated;
}

void apply(Axes& axes, double yaw_deg, double pitch_deg, double roll_deg) {
  rotate(axes.forward, axes.right, sin_cos_deg(yaw_deg));
  rotate(axes.forward, axes.up, sin_cos_deg(pitch_deg));
  rotate(axes.up, axes.right, sin_cos_deg(roll_deg));
}

}  // namespace

Axes oriented_axes(const LocalFrame& frame, double yaw_deg, double pitch_deg, double roll_deg) {
  Axes axes{frame.east, frame.up, frame.north};
  apply(axes, yaw_deg, pitch_deg, roll_deg);
  return axes;
}

CameraPose to_camera(const Pose& pose, double radius_m) { return to_camera(pose, HeadAngles{}, radius_m); }

CameraPose to_camera(const Pose& pose, const HeadAngles& head, double radius_m) {
  const LocalFrame frame = local_frame({pose.lon_deg, pose.lat_deg});
  CameraPose camera{frame.up * (radius_m + pose.alt_m),
                    oriented_axes(frame, pose.yaw_deg, pose.pitch_deg, pose.roll_deg)};
  apply(camera.axes, head.yaw_deg, head.pitch_deg, head.roll_deg);
  return camera;
}

Pose to_pose(const CameraPose& camera, double radius_m) {
  const LonLat place = lon_lat(camera.position_m);
  const LocalFrame frame = local_frame(place);
  const glm::dvec3& forward = camera.axes.forward;
  const double east = glm::dot(forward, frame.east);
  const double north = glm::dot(forward, frame.north);
  const double up = glm::dot(forward, frame.up);
  const double level = std::hypot(east, north);

  Pose pose;
  pose.lon_deg = place.lon_deg;
  pose.lat_deg = place.lat_deg;
  pose.alt_m = glm::length(camera.position_m) - radius_m;
  pose.pitch_deg = std::atan2(up, level) / kRadiansPerDegree;
  // Towards zenith or nadir the heading of `forward` is rounding noise; the camera's up axis has it then.
  constexpr double kNoise = 2e-15;
  if (level > kNoise) {
    pose.yaw_deg = std::atan2(east, north) / kRadiansPerDegree;
  } else {
    const double sign = up > 0.0 ? -1.0 : 1.0;
    pose.yaw_deg =
        std::atan2(sign * glm::dot(camera.axes.up, frame.east), sign * glm::dot(camera.axes.up, frame.north)) /
        kRadiansPerDegree;
  }
  const Axes unrolled = oriented_axes(frame, pose.yaw_deg, pose.pitch_deg, 0.0);
  pose.roll_deg = std::atan2(glm::dot(camera.axes.up, unrolled.right), glm::dot(camera.axes.up, unrolled.up)) /
                  kRadiansPerDegree;
  pose.yaw_deg = normalize_lon_deg(pose.yaw_deg);
  pose.roll_deg = normalize_lon_deg(pose.roll_deg);
  return pose;
}

}  // namespace mars
