// Foresees where the camera will be from how it has moved.
#pragma once

#include <optional>

#include "mars/geodesy/pose.h"

namespace vpe::explore {

// Holds two poses and the time between them.
struct Motion {
  mars::Pose before;
  mars::Pose now;
  double dt_s = 0;
};

// Returns the pose after `ahead_s` more seconds of the same motion: along the same great circle, turning and
// climbing at the same rates, at most kFarthest_rad and a right angle of turning away. Returns nullopt for a camera
// that rests, and for poses too far apart in time to tell a motion. It is a guess, for tiles to be loaded early.
// Pure.
std::optional<mars::Pose> foreseen(const Motion& motion, double ahead_s);
inline constexpr double kFarthest_rad = 0.5;
inline constexpr double kLongestStep_s = 0.5;

}  // namespace vpe::explore
