// Pose of a platform and its camera, and their position and axes in the body-fixed frame.
//
// Typical usage:
//   const Pose pose{.lon_deg = 137.4, .lat_deg = -4.6, .alt_m = 2000, .yaw_deg = 90};
//   const CameraPose camera = to_camera(pose, kMarsRadius_m);
//   const Pose same = to_pose(camera, kMarsRadius_m);
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"

namespace mars {

// Describes position and attitude of a platform. Yaw, pitch and roll are applied in this order.
struct Pose {
  double lon_deg = 0;
  double lat_deg = 0;
  double alt_m = 0;      // above the sphere
  double yaw_deg = 0;    // heading, clockwise from north
  double pitch_deg = 0;  // up from the local horizontal
  double roll_deg = 0;   // positive: the right wing is down, as the pilot sees it
};

// Describes the rotation of a head relative to its platform. The angles are applied in this order, in the frame
// of the platform.
struct HeadAngles {
  double yaw_deg = 0;    // to the right
  double pitch_deg = 0;  // up
  double roll_deg = 0;   // to the right
};

// Holds the unit axes of a camera. right x up = -forward: OpenGL's camera with z = -forward.
struct Axes {
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 0, 1};
  glm::dvec3 forward{0, 1, 0};
};

// Holds position and axes of a camera in the body-fixed frame.
struct CameraPose {
  glm::dvec3 position_m{0, 0, 0};  // from the planet's centre
  Axes axes;
};

// Bounds the error of direction, length and orthogonality of the axes from oriented_axes() and to_camera().
inline constexpr double kAxesError = 2e-15;

// Returns the axes after a rotation by yaw, pitch and roll relative to a local frame.
Axes oriented_axes(const LocalFrame& frame, double yaw_deg, double pitch_deg, double roll_deg);

// Bounds the position error of to_camera(), relative to |radius_m + alt_m|.
inline constexpr double kCameraPositionError = 1e-15;

// Returns the camera of a platform whose head is not turned.
CameraPose to_camera(const Pose& pose, double radius_m);

// Returns the camera of a platform whose head is turned.
CameraPose to_camera(const Pose& pose, const HeadAngles& head, double radius_m);

// Bound how much to_camera(to_pose(camera)) differs from `camera`: every axis by at most kToPoseAxesError_rad,
// the position by at most kToPosePositionError * (radius + altitude).
inline constexpr double kToPoseAxesError_rad = 1e-14;
inline constexpr double kToPosePositionError = 2e-15;

// Returns the pose of a camera: the inverse of to_camera(). Yaw and roll are in (-180, 180], pitch is in
// [-90, 90]. When the camera looks straight up or down, yaw and roll turn about the same axis; roll = 0 is
// returned then. Undefined for a camera at the planet's centre.
Pose to_pose(const CameraPose& camera, double radius_m);

}  // namespace mars
