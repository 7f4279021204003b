#include "vpe/explore/mover.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

bool is_same_place(const mars::Pose& a, const mars::Pose& b) {
  return a.lon_deg == b.lon_deg && a.lat_deg == b.lat_deg && a.alt_m == b.alt_m && a.yaw_deg == b.yaw_deg;
}

}  // namespace

Mover::Mover(const VehicleOptions& vehicle) : options_(vehicle) {
  if (const std::string fault = problem(vehicle); !fault.empty())
    throw std::invalid_argument("vehicle: " + fault);
}

void Mover::set_mode(MotionMode mode) {
  mode_ = mode;
  vehicle_.reset();
  rest();
}

void Mover::rest() {
  walker_.velocity_m_s = {0, 0};
  walker_.is_settled = false;  // the next frame finds out
  walker_.is_blocked = false;
  if (vehicle_) vehicle_->speed_m_s = 0;
}

bool Mover::is_moving() const {
  if (mode_ == MotionMode::kWalk) return explore::is_moving(walker_);
  return mode_ == MotionMode::kDrive && vehicle_ && vehicle_->speed_m_s != 0;
}

bool Mover::is_blocked() const {
  if (mode_ == MotionMode::kWalk) return walker_.is_blocked;
  return vehicle_ && vehicle_->is_blocked;
}

mars::Pose Mover::put(const mars::Pose& pose, const TerrainQuery& ground) const {
  const mars::Pose clear = kept_clear(pose, ground);
  if (mode_ == MotionMode::kWalk) return standing(clear, ground);
  if (mode_ == MotionMode::kDrive)
    return placed({clear.lon_deg, clear.lat_deg}, clear.yaw_deg, options_, ground).pose;
  return clear;
}

mars::Pose Mover::advance(const mars::Pose& pose, const Controls& controls, double dt_s,
                          const TerrainQuery& ground) {
  switch (mode_) {
    case MotionMode::kOrbit: return steered(pose, controls, dt_s, ground);
    case MotionMode::kFly: {
      Controls faster = controls;
      faster.speed *= speed_;
      return flown(pose, faster, dt_s, ground);
    }
    case MotionMode::kWalk:
      walker_.pose = pose;
      walker_ = walked(walker_, controls, dt_s, ground);
      return walker_.pose;
    case MotionMode::kDrive: break;
  }
  if (!vehicle_ || !is_same_place(vehicle_->pose, pose))
    vehicle_ = placed({pose.lon_deg, pose.lat_deg}, pose.yaw_deg, options_, ground);
  vehicle_ = driven(*vehicle_, controls, dt_s, options_, ground);
  return vehicle_->pose;
}

void Mover::add_speed(double notches) {
  if (!std::isfinite(notches)) return;
  speed_ = std::clamp(speed_ * std::pow(kSpeedNotch, std::clamp(notches, -100.0, 100.0)), kSlowest, kFastest);
}

}  // namespace vpe::explore
