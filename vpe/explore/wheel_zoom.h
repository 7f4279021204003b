// Zoom by the wheel: a goal that many notches move on, and the eased motion to it.
//
// Tilt on arrival: a camera that the wheel brings down from straight above looks up more and more, from -90 degrees
// at 8 km from the ground under the cursor to -30 degrees at 500 m. That ground stays under the cursor.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "vpe/explore/mouse.h"

namespace vpe::explore {

struct WheelLimits {
  static constexpr double kNotch = 1.35;            // a notch divides or multiplies the distance by this
  static constexpr double kTime_s = 0.15;           // after the last notch the goal is reached
  static constexpr double kArrivalFrom_m = 8000;    // distance at which the tilt on arrival begins
  static constexpr double kArrivalTo_m = 500;       // and ends
  static constexpr double kArrivalPitch_deg = -30;  // pitch at its end
};

// Returns the pitch of a camera that comes from straight above, at a distance of the ground: -90 from kArrivalFrom_m
// on, kArrivalPitch_deg to kArrivalTo_m, between them a smooth function of the logarithm of the distance. Pure.
double arrival_pitch_deg(double distance_m);

// Pitches a camera without roll about a point of the ground at the same distance. The point stays at `xy`. Pure.
mars::Pose pitched_about(const mars::Pose& pose, const Screen& screen, const glm::dvec3& held_m, glm::dvec2 xy,
                         double pitch_deg, const TerrainQuery& ground);

// Holds a motion from one pose to another, during which a point of the ground stays under the cursor.
struct WheelMotion {
  mars::Pose from;
  mars::Pose to;
  std::optional<glm::dvec3> held_m;  // nullopt: the cursor is over the sky
  double time_s = 0;                 // since the last notch
};

// Returns the pose at a time after the last notch, before the held point is brought under the cursor (dragged() in
// vpe/explore/mouse.h does this): the distance of the held point changes geometrically, angles by the shorter way.
// Fast at first, at rest at the end; from kTime_s on exactly `to`. Pure.
mars::Pose pose_at(const WheelMotion& motion, double time_s, const TerrainQuery& ground);

}  // namespace vpe::explore
