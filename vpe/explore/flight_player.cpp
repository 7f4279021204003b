#include "vpe/explore/flight_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

double finite(double value) { return std::isfinite(value) ? value : 0.0; }

double within_reach_m(double value) {
  return std::clamp(finite(value), -FlightPlayerLimits::kFarthest_m, FlightPlayerLimits::kFarthest_m);
}

bool is_ahead(const mars::HeadAngles& head) {
  return head.yaw_deg == 0 && head.pitch_deg == 0 && head.roll_deg == 0;
}

}  // namespace

FlightPlayer::FlightPlayer(scripts::Path path, double radius_m) : path_(std::move(path)), radius_m_(radius_m) {}

void FlightPlayer::play() {
  if (speed_ > 0 && at_end()) time_s_ = 0;
  if (speed_ < 0 && at_start()) time_s_ = duration_s();
  playing_ = true;
}

void FlightPlayer::advance(double dt_s) {
  if (!playing_ || !(dt_s > 0)) return;
  const double length_s = duration_s();
  const double next_s = time_s_ + dt_s * speed_;
  if (next_s > 0 && next_s < length_s) {
    time_s_ = next_s;
  } else if (loop_ && length_s > 0 && std::isfinite(next_s)) {
    time_s_ = std::fmod(next_s, length_s);
    if (time_s_ < 0) time_s_ += length_s;
  } else {
    time_s_ = speed_ > 0 ? length_s : 0.0;
    playing_ = loop_ && length_s > 0;
  }
}

void FlightPlayer::scrub(double time_s) { time_s_ = time_s > 0 ? std::min(time_s, duration_s()) : 0.0; }

void FlightPlayer::set_speed(double speed) {
  if (speed == 0 || !std::isfinite(speed)) return;
  const double size = std::clamp(std::abs(speed), FlightPlayerLimits::kSlowest, FlightPlayerLimits::kFastest);
  speed_ = std::copysign(size, speed);
}

void FlightPlayer::set_look_offset(const mars::HeadAngles& offset) {
  offset_ = {mars::normalize_lon_deg(finite(offset.yaw_deg)),
             std::clamp(finite(offset.pitch_deg), -180.0, 180.0),
             mars::normalize_lon_deg(finite(offset.roll_deg))};
}

void FlightPlayer::add_look_offset(double yaw_deg, double pitch_deg, double roll_deg) {
  // The sum is clamped here, so that a rotation back takes effect immediately.
  const double flight_deg = path_.at(time_s_).head.pitch_deg;
  const double pitch = std::clamp(flight_deg + offset_.pitch_deg + finite(pitch_deg), -90.0, 90.0) - flight_deg;
  set_look_offset({offset_.yaw_deg + finite(yaw_deg), pitch, offset_.roll_deg + finite(roll_deg)});
}

void FlightPlayer::set_platform_offset(const PlatformOffset& offset) {
  platform_ = {within_reach_m(offset.right_m), within_reach_m(offset.up_m), within_reach_m(offset.forward_m)};
}

scripts::FlightState FlightPlayer::state_at(double time_s) const {
  scripts::FlightState state = path_.at(std::clamp(time_s, 0.0, duration_s()));
  const bool is_on_course = platform_ == PlatformOffset{};
  if (is_on_course && is_ahead(offset_)) return state;
  if (!is_on_course) {
    state.pose = carried(state.pose, platform_.right_m, platform_.forward_m, radius_m_);
    state.pose.alt_m = std::max(state.pose.alt_m + platform_.up_m, -0.5 * radius_m_);
  }
  state.head = {mars::normalize_lon_deg(state.head.yaw_deg + offset_.yaw_deg),
                std::clamp(state.head.pitch_deg + offset_.pitch_deg, -90.0, 90.0),
                mars::normalize_lon_deg(state.head.roll_deg + offset_.roll_deg)};
  state.camera = mars::to_camera(state.pose, state.head, radius_m_);
  return state;
}

core::Settings FlightPlayer::settings(const core::Settings& base) const {
  core::Settings settings = base;
  path_.apply_settings(time_s_, settings);
  for (const auto& [key, text] : kept_) {
    // keep_setting() has checked it.
    static_cast<void>(settings.set(key, text));
  }
  return settings;
}

scripts::ViewState FlightPlayer::view() const {
  scripts::ViewState view = path_.at(time_s_).view;
  if (keeps_.fov) view.fov_deg.reset();
  if (keeps_.backend) view.backend.reset();
  if (keeps_.eyes) {
    view.eyes.reset();
    view.eye_base_m.reset();
    view.convergence_m.reset();
  }
  return view;
}

std::string FlightPlayer::keep_setting(const std::string& key, const std::string& text) {
  std::string problem = core::Settings().set(key, text);
  if (problem.empty()) kept_[key] = text;
  return problem;
}

}  // namespace vpe::explore
