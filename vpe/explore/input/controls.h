// What hands ask for, whatever device they hold: one vocabulary for keys, gamepad and space mouse.
#pragma once

#include <span>

namespace vpe::explore {

// Rates, -1..1 each, in the camera's own axes. 1 is full speed: of moving, a share of the height above ground a
// second; of turning, degrees a second (vpe/explore/motion.h).
struct Controls {
  double right = 0;
  double up = 0;
  double forward = 0;
  double yaw_right = 0;
  double pitch_up = 0;
  double roll_right = 0;
  double speed = 1;  // factor of moving, > 0

  bool operator==(const Controls&) const = default;
};

// Whether anything is asked for.
bool any(const Controls& controls);

// Of several devices at once: rates are added and kept to -1..1, factors multiplied and kept to 0.01..100.
// Numbers that are not finite count as 0 (a factor as 1).
Controls combine(std::span<const Controls> devices);

}  // namespace vpe::explore
