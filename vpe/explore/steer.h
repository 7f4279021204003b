// How a camera moves over a planet: by rates, by a step, and clear of the ground.
//
// Moving is along great circles: what is ahead in the horizontal is an arc, what is up is altitude, and the
// attitude stays as it is towards the local horizon. All functions are pure; poses are valid (|lat| <= 90,
// finite).
#pragma once

#include <glm/vec3.hpp>

#include "mars/geodesy/pose.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct SteerLimits {
  static constexpr double kClearance_m = 1.0;   // of the camera above the ground below it, at least
  static constexpr double kHighest_radii = 10;  // above the sphere
  static constexpr double kSpeed_per_s = 0.7;   // of the height above ground, at full deflection
  static constexpr double kSlowest_m_s = 3.0;   // full deflection near the ground
  static constexpr double kTurn_deg_s = 45;     // of yaw and pitch, at full deflection
  static constexpr double kRoll_deg_s = 60;
  static constexpr double kLongestStep_s = 0.1;  // longer frames count as that: nobody flies blind
};

double height_above_ground_m(const mars::Pose& pose, const TerrainQuery& ground);

// Metres a second at full deflection at a place.
double full_speed_m_s(const mars::Pose& pose, const TerrainQuery& ground);

// The same pose, raised where it is less than the clearance above the ground, lowered to the highest altitude,
// with longitude and angles in their ranges (pitch within -90..90).
mars::Pose kept_clear(const mars::Pose& pose, const TerrainQuery& ground,
                      double clearance_m = SteerLimits::kClearance_m);

// Moves by metres in the camera's level frame (right and forward horizontal, up), in steps short enough that the
// ground between is met: the camera rides over what stands in its way and never passes through it.
mars::Pose moved(const mars::Pose& pose, double right_m, double up_m, double forward_m,
                 const TerrainQuery& ground);

// Turns in the camera's place. Pitch ends at straight up and straight down; yaw and roll go on for ever.
mars::Pose turned(const mars::Pose& pose, double yaw_deg, double pitch_deg, double roll_deg);

// What the controls do within a frame of dt_s seconds: moving is along the camera's own axes (its view), turning
// about the local vertical.
mars::Pose steered(const mars::Pose& pose, const Controls& controls, double dt_s, const TerrainQuery& ground);

}  // namespace vpe::explore
