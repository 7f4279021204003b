// Motion by the controls in each mode: orbit, fly, walk, drive.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "mars/geodesy/pose.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/motion_mode.h"
#include "vpe/explore/terrain_query.h"
#include "vpe/explore/vehicle.h"
#include "vpe/explore/walk.h"

namespace vpe::explore {

// Holds the mode and what it remembers between frames: the speed factor of flying, the walker's momentum, the
// vehicle. For one thread at a time. The pose belongs to the caller, who may change it at any time.
//
// Typical usage, in each frame:
//   pose = mover.advance(pose, controls, dt_s, ground);
class Mover {
 public:
  static constexpr double kSpeedNotch = 1.25;  // of the wheel, on the speed of flying
  static constexpr double kSlowest = 1.0 / 64;
  static constexpr double kFastest = 64;

  // Throws std::invalid_argument for options beyond their limits.
  explicit Mover(const VehicleOptions& vehicle = {});

  MotionMode mode() const { return mode_; }
  // Changes the mode; what was in motion rests.
  void set_mode(MotionMode mode);
  // Returns true if the camera stands on the ground: walk and drive.
  bool is_on_ground() const { return mode_ == MotionMode::kWalk || mode_ == MotionMode::kDrive; }

  // Ends the momentum.
  void rest();
  // Returns true if the next frame moves without controls.
  bool is_moving() const;

  // Returns the pose as the mode holds it: on the ground, or at least above it.
  mars::Pose put(const mars::Pose& pose, const TerrainQuery& ground) const;

  // Returns the pose after a frame.
  mars::Pose advance(const mars::Pose& pose, const Controls& controls, double dt_s, const TerrainQuery& ground);

  // Multiplies the speed of flying by kSpeedNotch for each notch, within the limits.
  void add_speed(double notches);
  double speed() const { return speed_; }  // factor on the speed of flying

  // Returns true if a slope that is too steep stops the walker or the vehicle.
  bool is_blocked() const;
  // Returns how the vehicle stands, or null in other modes and before its first frame.
  const Contact* contact() const { return vehicle_ ? &vehicle_->contact : nullptr; }
  const VehicleOptions& vehicle_options() const { return options_; }

 private:
  MotionMode mode_ = MotionMode::kOrbit;
  double speed_ = 1;
  Walker walker_;
  VehicleOptions options_;
  std::optional<Vehicle> vehicle_;
};

}  // namespace vpe::explore
