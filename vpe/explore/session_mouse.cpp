// Mouse input of a session, and the motions that it leaves behind.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/explore/look.h"
#include "vpe/explore/session.h"
#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kTilt_deg_px = 0.25;  // of a drag, on an image of 720 rows
constexpr double kLook_deg_px = 0.1;   // of a cursor that is caught, at a field of view of 50 degrees
constexpr double kFovNotch = 0.8;      // of the field of view
constexpr double kDoubleClick = 0.4;   // of the distance
constexpr double kStraightDown_deg = -89.5;

}  // namespace

double Session::signed_notches(double notches) const {
  if (!std::isfinite(notches)) return 0;
  return std::clamp(mouse_.invert_wheel ? -notches : notches, -10.0, 10.0);
}

void Session::press(MouseUse use, glm::dvec2 xy, std::optional<double> time_s) {
  going_.reset();
  throw_.reset();
  wheel_.reset();
  const bool looks = follows_ || mode() != MotionMode::kOrbit;
  use_ = looks && use != MouseUse::kNone ? MouseUse::kLook : use;
  begun_ = seen();
  begun_xy_ = xy;
  held_m_.reset();
  if (use_ == MouseUse::kHold) held_m_ = ground_at(begun_, screen_, xy, ground_);
  if (use_ == MouseUse::kTilt)
    held_m_ = ground_at(begun_, screen_, {screen_.width / 2.0, screen_.height / 2.0}, ground_);
  samples_.clear();
  if (time_s) samples_.add(*time_s, xy, pose_);
}

void Session::drag(glm::dvec2 xy, std::optional<double> time_s) {
  switch (use_) {
    case MouseUse::kNone: return;
    case MouseUse::kHold:
      pose_ = platform_of(held_m_ ? dragged(begun_, screen_, *held_m_, xy, ground_)
                                  : panned(begun_, screen_, begun_xy_, xy));
      if (time_s) samples_.add(*time_s, xy, pose_);
      return;
    case MouseUse::kTilt: {
      const glm::dvec2 by = (xy - begun_xy_) * (mouse_.speed * kTilt_deg_px * 720.0 / screen_.height);
      pose_ = platform_of(tilted(begun_, screen_, by.x, by.y, ground_));
      return;
    }
    case MouseUse::kLook: {
      // The direction that was under the cursor is there again. Step by step, since the platform may move.
      const mars::Pose from = seen();
      const mars::Pose to = panned(from, screen_, begun_xy_, xy);
      begun_xy_ = xy;
      look_around(mouse_.speed * std::remainder(to.yaw_deg - from.yaw_deg, 360.0),
                  mouse_.speed * (to.pitch_deg - from.pitch_deg));
      return;
    }
  }
}

void Session::release(std::optional<double> time_s) {
  if (use_ == MouseUse::kHold && time_s && mouse_.throws && !follows_) {
    if (const auto motion = samples_.motion(*time_s, screen_.height)) throw_ = Throw{*motion, 0};
  }
  use_ = MouseUse::kNone;
  samples_.clear();
}

void Session::look_by(double dx_px, double dy_px) {
  const double deg_px = mouse_.speed * kLook_deg_px * screen_.fov_deg / 50.0;
  look_around(dx_px * deg_px, -dy_px * deg_px);
}

// Turns the view about the vertical of the place, and up.
void Session::look_around(double yaw_deg, double pitch_deg) {
  if (!std::isfinite(yaw_deg) || !std::isfinite(pitch_deg)) return;
  const double radius_m = ground_.radius_m;
  if (follows_) {
    FlightPlayer* flight = player();
    if (flight == nullptr) return;
    const mars::HeadAngles wanted = turned_look(pose_, look_, yaw_deg, pitch_deg, radius_m);
    // The offset is what is left of it beside the flight's own look and the tracker.
    const mars::HeadAngles own = flight->path().at(flight->time_s()).head;
    flight->set_look_offset({wanted.yaw_deg - own.yaw_deg - tracker_.yaw_deg,
                             wanted.pitch_deg - own.pitch_deg - tracker_.pitch_deg,
                             wanted.roll_deg - own.roll_deg - tracker_.roll_deg});
    take_flight_state(tracker_);
    return;
  }
  if (mode() == MotionMode::kDrive) {
    look_ = turned_look(pose_, look_, yaw_deg, pitch_deg, radius_m);
    drive_look_ = {std::remainder(look_.yaw_deg - tracker_.yaw_deg, 360.0),
                   std::clamp(look_.pitch_deg - tracker_.pitch_deg, -90.0, 90.0),
                   std::remainder(look_.roll_deg - tracker_.roll_deg, 360.0)};
    return;
  }
  pose_ = platform_of(rotated(seen(), yaw_deg, pitch_deg, 0.0));
}

void Session::zoom_view(double notches) { zoom(std::pow(kFovNotch, notches)); }

void Session::wheel(glm::dvec2 xy, double notches) {
  const double n = signed_notches(notches);
  if (n == 0) return;
  if (follows_ || mover_.is_on_ground()) return zoom_view(n);
  if (mode() == MotionMode::kFly) return mover_.add_speed(n);
  // A drag in progress goes on from the goal.
  going_.reset();
  throw_.reset();
  const mars::Pose from = wheel_ ? wheel_->motion.to : pose_;
  const std::optional<glm::dvec3> held = ground_at(seen_of(from), screen_, xy, ground_);
  const double factor = std::clamp(std::pow(WheelLimits::kNotch, -n), 0.1, 10.0);
  const mars::Pose to = wheeled(from, xy, factor);
  wheel_ = Wheel{{pose_, to, held, 0}, xy};
}

// Returns the goal of the wheel, with the tilt on arrival.
mars::Pose Session::wheeled(const mars::Pose& from, glm::dvec2 xy, double factor) {
  const mars::Pose before = seen_of(from);
  mars::Pose to = zoomed(before, screen_, xy, factor, ground_);
  const bool is_ahead = look_.yaw_deg == 0 && look_.pitch_deg == 0 && look_.roll_deg == 0;
  const bool arrives = from.pitch_deg < kStraightDown_deg || arrival_pitch_deg_ == from.pitch_deg;
  if (mouse_.tilt_on_arrival && !is_orthographic() && is_ahead && arrives && from.roll_deg == 0) {
    if (const auto held = ground_at(before, screen_, xy, ground_)) {
      const auto distance_m = [&](const mars::Pose& pose) {
        return glm::length(mars::to_camera(pose, ground_.radius_m).position_m - *held);
      };
      const double by_deg =
          explore::arrival_pitch_deg(distance_m(to)) - explore::arrival_pitch_deg(distance_m(before));
      const double pitch_deg = std::clamp(from.pitch_deg + by_deg, -90.0, WheelLimits::kArrivalPitch_deg);
      if (pitch_deg != from.pitch_deg) to = pitched_about(to, screen_, *held, xy, pitch_deg, ground_);
      arrival_pitch_deg_ = to.pitch_deg;
    }
  }
  return platform_of(to);
}

bool Session::go_on(double dt_s) {
  if (wheel_) {
    wheel_->motion.time_s += dt_s;
    const WheelMotion& motion = wheel_->motion;
    pose_ = pose_at(motion, motion.time_s, ground_);
    if (motion.time_s >= WheelLimits::kTime_s) {
      wheel_.reset();
    } else if (motion.held_m) {
      pose_ = platform_of(dragged(seen(), screen_, *motion.held_m, wheel_->xy, ground_));
    }
    return true;
  }
  if (throw_) {
    throw_->time_s += dt_s;
    pose_ = thrown(throw_->motion, throw_->time_s, ground_);
    if (throw_->time_s >= ThrowLimits::kTime_s) throw_.reset();
    return true;
  }
  return false;
}

void Session::fly_towards(glm::dvec2 xy) {
  if (follows_) return;
  const mars::Pose from = seen();
  const std::optional<glm::dvec3> point = ground_at(from, screen_, xy, ground_);
  if (!point) return;
  if (mover_.is_on_ground()) {
    const mars::LonLat place = mars::lon_lat(*point);
    mars::Pose goal = pose_;
    goal.lon_deg = place.lon_deg;
    goal.lat_deg = place.lat_deg;
    goal.alt_m = ground_.height_m(*point);
    return go(goal);
  }
  const double distance_m = glm::length(mars::to_camera(from, ground_.radius_m).position_m - *point);
  go(platform_of(looking_at(from, *point, distance_m * kDoubleClick, ground_)));
}

}  // namespace vpe::explore
