// Pose of a platform or a head, and its place and axes in the body-fixed frame.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"

namespace mars {

// yaw = heading clockwise from north, pitch = up from the local horizontal, roll = right wing down as the
// pilot sees it; applied in that order. alt_m is above the sphere.
struct Pose {
  double lon_deg = 0;
  double lat_deg = 0;
  double alt_m = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};

// A head turned on its platform: yaw right, pitch up, roll right, applied in the platform's own frame.
struct HeadAngles {
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};

// Unit axes of what looks: right, up and forward; right x up = -forward (OpenGL's camera with z = -forward).
struct Axes {
  glm::dvec3 right;
  glm::dvec3 up;
  glm::dvec3 forward;
};

// Camera in metres from the planet's centre, and its axes, in the body-fixed frame.
struct CameraPose {
  glm::dvec3 position_m;
  Axes axes;
};

// Axes of yaw, pitch, roll relative to a local frame. Their directions, lengths and products are right within
// kAxesError; the same for to_camera().
inline constexpr double kAxesError = 2e-15;
Axes oriented_axes(const LocalFrame& frame, double yaw_deg, double pitch_deg, double roll_deg);

// Error of the position <= kEyePositionError * |radius_m + alt_m|.
inline constexpr double kCameraPositionError = 1e-15;
CameraPose to_camera(const Pose& pose, double radius_m);

// The same with the head turned on its platform.
CameraPose to_camera(const Pose& pose, const HeadAngles& look, double radius_m);

// Inverse of to_camera: angles in (-180, 180], pitch in [-90, 90]. Looking straight up or down, where yaw and
// roll turn about the same axis, roll = 0 is chosen. to_camera(to_pose(e)) agrees with e within
// kToPoseAxesError_rad in every axis and kToPosePositionError * (radius + alt) in position. Undefined for an
// camera at the planet's centre.
inline constexpr double kToPoseAxesError_rad = 1e-14;
inline constexpr double kToPosePositionError = 2e-15;
Pose to_pose(const CameraPose& camera, double radius_m);

}  // namespace mars
