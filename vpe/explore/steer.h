// Motion of a camera over a planet: by rates or by a step, always above the ground.
//
// Horizontal motion follows great circles, vertical motion changes the altitude, and the attitude relative to
// the local horizon stays. All functions are pure. Poses are valid (|lat| <= 90, finite).
#pragma once

#include <glm/vec3.hpp>

#include "mars/geodesy/pose.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct SteerLimits {
  static constexpr double kClearance_m = 1.0;    // least height of the camera above the ground below it
  static constexpr double kHighest_radii = 10;   // above the sphere; of TerrainQuery, unless it has another
  static constexpr double kSpeed_per_s = 0.7;    // of the height above ground, at full deflection
  static constexpr double kSlowest_m_s = 3.0;    // full deflection near the ground
  static constexpr double kRotation_deg_s = 45;  // of yaw and pitch, at full deflection
  static constexpr double kRoll_deg_s = 60;
  static constexpr double kLongestStep_s = 0.1;  // longer frames count as this: no motion without an image
};

double height_above_ground_m(const mars::Pose& pose, const TerrainQuery& ground);

// Returns the speed at full deflection, metres a second.
double full_speed_m_s(const mars::Pose& pose, const TerrainQuery& ground);

// Returns the pose raised to the clearance above the ground, or lowered to the highest altitude, if needed,
// with longitude and angles normalized (pitch clamped to -90..90).
mars::Pose kept_clear(const mars::Pose& pose, const TerrainQuery& ground,
                      double clearance_m = SteerLimits::kClearance_m);

// Moves horizontally by metres along a great circle, turning with it, at the same altitude and without regard to the
// ground. No query of the ground.
mars::Pose carried(const mars::Pose& pose, double right_m, double forward_m, double radius_m);

// Moves by metres in the camera's level frame (right and forward are horizontal). Steps are short enough that
// the camera passes over obstacles on the way and never through them.
mars::Pose moved(const mars::Pose& pose, double right_m, double up_m, double forward_m,
                 const TerrainQuery& ground);

// Rotates the camera in place. Pitch is clamped to straight up and straight down; yaw and roll are not limited.
mars::Pose rotated(const mars::Pose& pose, double yaw_deg, double pitch_deg, double roll_deg);

// Applies controls for a frame of dt_s seconds: motion is along the camera's own axes, rotation about the local
// vertical.
mars::Pose steered(const mars::Pose& pose, const Controls& controls, double dt_s, const TerrainQuery& ground);

// Applies controls for a frame of dt_s seconds: motion is along the horizon and the vertical, whatever the pitch and
// roll, so that `forward` keeps the altitude over even ground.
mars::Pose flown(const mars::Pose& pose, const Controls& controls, double dt_s, const TerrainQuery& ground);

}  // namespace vpe::explore
