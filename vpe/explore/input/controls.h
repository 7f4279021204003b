// Continuous input of the user: one vocabulary for keys, gamepad and space mouse.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <stdexcept>

namespace vpe::explore {

// Holds rates of -1..1 in the camera's own axes. 1 is full speed: for motion, a share of the height above
// ground a second; for rotation, degrees a second (SteerLimits in vpe/explore/steer.h).
struct Controls {
  double right = 0;
  double up = 0;
  double forward = 0;
  double yaw_right = 0;
  double pitch_up = 0;
  double roll_right = 0;
  double speed = 1;  // factor on motion, > 0

  bool operator==(const Controls&) const = default;
};

// Returns true if any rate is not 0.
bool any(const Controls& controls);

// Combines the input of several devices: rates are added and clamped to -1..1, factors multiplied and clamped
// to 0.01..100. Rates that are not finite count as 0, factors as 1.
Controls combine(std::span<const Controls> devices);

// Converts a deflection of 0..1 to a rate of 0..1: zero within the dead zone (0..1), beyond it the share of the
// rest raised to the power of `curve`. The result is increasing, continuous, and 1 at 1. A deflection that is
// not finite counts as 0.
double stick_rate(double deflection, double dead_zone, double curve);

// Converts a deflection of -1..1 likewise and keeps its sign.
double axis_rate(double deflection, double dead_zone, double curve);

// Converts the deflection of two axes together: the dead zone is round, and the direction is kept, so that the
// motion does not snap to the axes.
glm::dvec2 stick_rates(const glm::dvec2& deflection, double dead_zone, double curve);

// Thrown if a device cannot be used. what() names the device, the system's message, and what to do.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vpe::explore
