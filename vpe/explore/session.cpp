#include "vpe/explore/session.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kTilt_deg_px = 0.25;  // of a drag, on an image of 720 rows
constexpr double kWheelNotch = 0.8;    // of the distance
constexpr double kDoubleClick = 0.4;   // of the distance

// Adds angles. Pitch is clamped: a log cannot hold a steeper look.
mars::HeadAngles added(const mars::HeadAngles& a, const mars::HeadAngles& b) {
  return {std::remainder(a.yaw_deg + b.yaw_deg, 360.0), std::clamp(a.pitch_deg + b.pitch_deg, -90.0, 90.0),
          std::remainder(a.roll_deg + b.roll_deg, 360.0)};
}

scripts::TerrainHeight terrain_height_of(std::shared_ptr<const paging::Surface> surface) {
  return [ground = std::move(surface)](mars::LonLat place, double exaggeration) {
    return ground->at(mars::direction(place), exaggeration).height_m;
  };
}

bool is_ahead(const mars::HeadAngles& look) {
  return look.yaw_deg == 0 && look.pitch_deg == 0 && look.roll_deg == 0;
}

}  // namespace

Session::Session(std::shared_ptr<const paging::Surface> surface, const SessionOptions& options)
    : surface_(std::move(surface)),
      settings_(options.settings),
      shown_settings_(options.settings),
      flights_(surface_->planet_radius_m(), terrain_height_of(surface_)),
      interest_(options.interest),
      mouse_speed_(options.mouse_speed),
      invert_wheel_(options.invert_wheel) {
  ground_ = ground_of(surface_, settings_.values().exaggeration);
  set_fov(options.fov_deg);
  pose_ = kept_clear(options.start ? *options.start : overview({0, 0}, screen_, ground_.radius_m), ground_);
}

void Session::set_surface(std::shared_ptr<const paging::Surface> surface) {
  surface_ = std::move(surface);
  flights_.set_terrain(terrain_height_of(surface_));
  ground_ = ground_of(surface_, shown_settings_.values().exaggeration);
  if (!follows_) pose_ = kept_clear(pose_, ground_);
  ++changes_;
}

double Session::height_m() const { return height_above_ground_m(pose_, ground_); }

core::View Session::view() const {
  core::View view = view_of(pose_, screen_, ground_.radius_m);
  view.camera = mars::to_camera(pose_, look_, ground_.radius_m);
  return view;
}

mars::Pose Session::seen() const {
  return is_ahead(look_) ? pose_
                         : mars::to_pose(mars::to_camera(pose_, look_, ground_.radius_m), ground_.radius_m);
}

// Removes the head's rotation (axes right, ahead and up of its platform) from the camera's axes.
mars::Pose Session::platform_of(const mars::Pose& seen) const {
  if (is_ahead(look_)) return seen;
  const mars::CameraPose camera = mars::to_camera(seen, ground_.radius_m);
  const mars::Axes head =
      mars::oriented_axes({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, look_.yaw_deg, look_.pitch_deg, look_.roll_deg);
  const auto axis = [&](int k) {
    return camera.axes.right * head.right[k] + camera.axes.up * head.up[k] +
           camera.axes.forward * head.forward[k];
  };
  return mars::to_pose({camera.position_m, {axis(0), axis(2), axis(1)}}, ground_.radius_m);
}

double Session::wheel_factor(double notches) const {
  return std::pow(kWheelNotch, std::clamp(invert_wheel_ ? -notches : notches, -10.0, 10.0));
}

std::string Session::set(std::string_view key, std::string_view text) {
  const std::string problem = settings_.set(key, text);
  if (!problem.empty()) return problem;
  if (follows_) {
    if (FlightPlayer* flight = player(); flight != nullptr)
      (void)flight->keep_setting(std::string(key), std::string(text));
  }
  follow_settings();
  return {};
}

// Updates the settings in effect: the user's, and those of a followed flight.
void Session::follow_settings() {
  FlightPlayer* flight = follows_ ? player() : nullptr;
  const core::Settings next = flight != nullptr ? flight->settings(settings_) : settings_;
  if (next == shown_settings_) return;
  const double before = shown_settings_.values().exaggeration;
  shown_settings_ = next;
  ++changes_;
  if (shown_settings_.values().exaggeration == before) return;
  ground_ = ground_of(surface_, shown_settings_.values().exaggeration);
  if (!follows_) pose_ = kept_clear(pose_, ground_);
}

std::vector<core::InterestRegion> Session::all_interest() {
  std::vector<core::InterestRegion> all = interest_;
  if (FlightPlayer* flight = follows_ ? player() : nullptr; flight != nullptr) {
    for (const scripts::InterestCommand& command : flight->interests()) all.push_back(command.region);
  }
  return all;
}

void Session::set_interest(std::vector<core::InterestRegion> regions) {
  interest_ = std::move(regions);
  ++changes_;
}

void Session::resize(int width, int height) {
  screen_.width = std::max(1, width);
  screen_.height = std::max(1, height);
}

void Session::set_fov(double fov_deg) {
  if (std::isfinite(fov_deg)) screen_.fov_deg = std::clamp(fov_deg, kMinFov_deg, kMaxFov_deg);
}

std::string Session::follow(bool play) {
  FlightPlayer* flight = player();
  if (flight == nullptr)
    return flights_.problem().empty() ? "there is no flight yet; place waypoints or open a flight"
                                      : flights_.problem();
  stop();
  follows_ = true;
  if (play)
    flight->play();
  else
    flight->pause();
  take_flight_state(tracker_);
  return {};
}

void Session::leave_flight() {
  if (!follows_) return;
  if (FlightPlayer* flight = player(); flight != nullptr) {
    flight->pause();
    flight->reset_look_offset();
    flight->release_settings();
  }
  follows_ = false;
  follow_settings();
  pose_ = kept_clear(pose_, ground_);
  look_ = tracker_;
}

void Session::scrub(double time_s) {
  FlightPlayer* flight = player();
  if (flight == nullptr) return;
  stop();
  follows_ = true;
  flight->scrub(time_s);
  take_flight_state(tracker_);
}

void Session::take_flight_state(const mars::HeadAngles& tracker) {
  FlightPlayer* flight = player();
  if (flight == nullptr) {
    leave_flight();
    return;
  }
  const scripts::FlightState state = flight->state();
  pose_ = state.pose;
  look_ = added(state.head, tracker);
  follow_settings();
}

void Session::put(const mars::Pose& pose) {
  leave_flight();
  stop();
  pose_ = kept_clear(pose, ground_);
}

void Session::go(const mars::Pose& pose) {
  leave_flight();
  going_.emplace(pose_, kept_clear(pose, ground_), ground_);
  gone_s_ = 0;
}

void Session::go_to(mars::LonLat place) {
  mars::Pose goal = pose_;
  goal.lon_deg = place.lon_deg;
  goal.lat_deg = place.lat_deg;
  double height = height_m();
  if (height > ground_.radius_m) {
    height = ground_.radius_m / 2;
    goal.pitch_deg = -90;
  }
  goal.alt_m = ground_.height_m(mars::direction(place)) + height;
  go(goal);
}

void Session::go_rotated(double yaw_deg, double pitch_deg, double roll_deg) {
  mars::Pose goal = pose_;
  goal.yaw_deg = yaw_deg;
  goal.pitch_deg = pitch_deg;
  goal.roll_deg = roll_deg;
  go(goal);
}

void Session::look_down(bool north_up) {
  mars::Pose goal = pose_;
  goal.roll_deg = 0;
  goal = tilted(goal, screen_, 0, 180, ground_);
  // If the middle shows sky, the camera rotates in place.
  goal.pitch_deg = -90;
  if (north_up) goal.yaw_deg = 0;
  go(goal);
}

void Session::show_planet() { go(overview({pose_.lon_deg, pose_.lat_deg}, screen_, ground_.radius_m)); }

void Session::advance(double dt_s, const Controls& controls, const mars::HeadAngles& tracker) {
  tracker_ = tracker;
  if (follows_) {
    FlightPlayer* flight = player();
    const bool moves = controls.right != 0 || controls.up != 0 || controls.forward != 0;
    if (flight != nullptr && (flight->is_playing() || !moves)) {
      const double dt = std::min(std::max(dt_s, 0.0), SteerLimits::kLongestStep_s);
      flight->add_look_offset(controls.yaw_right * SteerLimits::kRotation_deg_s * dt,
                              controls.pitch_up * SteerLimits::kRotation_deg_s * dt,
                              controls.roll_right * SteerLimits::kRoll_deg_s * dt);
      if (flight->is_playing()) flight->advance(std::max(dt_s, 0.0));
      take_flight_state(tracker);
      return;
    }
    leave_flight();
  }
  look_ = tracker;
  if (any(controls)) stop();
  if (going_) {
    gone_s_ += std::max(dt_s, 0.0);
    pose_ = going_->at(gone_s_, ground_);
    if (gone_s_ >= going_->duration_s()) going_.reset();
    return;
  }
  pose_ = steered(pose_, controls, dt_s, ground_);
}

void Session::press(MouseUse use, glm::dvec2 xy) {
  stop();
  use_ = use;
  begun_ = seen();
  begun_xy_ = xy;
  held_m_ = use == MouseUse::kHold && !follows_ ? ground_at(begun_, screen_, xy, ground_) : std::nullopt;
  if (FlightPlayer* flight = follows_ ? player() : nullptr; flight != nullptr)
    begun_look_ = flight->look_offset();
}

void Session::drag(glm::dvec2 xy) {
  if (follows_) {
    FlightPlayer* flight = player();
    if (flight == nullptr || use_ == MouseUse::kNone) return;
    // Dragging holds the sky: dragging to the left looks to the right.
    const mars::Pose rotation = panned({0, 0, 0, 0, 0, 0}, screen_, begun_xy_, xy);
    flight->set_look_offset({begun_look_.yaw_deg + mouse_speed_ * rotation.yaw_deg,
                             begun_look_.pitch_deg + mouse_speed_ * rotation.pitch_deg, begun_look_.roll_deg});
    take_flight_state(tracker_);
    return;
  }
  if (use_ == MouseUse::kHold) {
    pose_ = platform_of(held_m_ ? dragged(begun_, screen_, *held_m_, xy, ground_)
                                : panned(begun_, screen_, begun_xy_, xy));
  } else if (use_ == MouseUse::kTilt) {
    const glm::dvec2 by = (xy - begun_xy_) * (mouse_speed_ * kTilt_deg_px * 720.0 / screen_.height);
    pose_ = platform_of(tilted(begun_, screen_, by.x, by.y, ground_));
  }
}

void Session::wheel(glm::dvec2 xy, double notches) {
  if (follows_) {
    set_fov(screen_.fov_deg * wheel_factor(notches));
    return;
  }
  stop();
  pose_ = platform_of(zoomed(seen(), screen_, xy, wheel_factor(notches), ground_));
}

void Session::fly_towards(glm::dvec2 xy) {
  if (follows_) return;
  const mars::Pose from = seen();
  const std::optional<glm::dvec3> point = ground_at(from, screen_, xy, ground_);
  if (!point) return;
  const double distance_m = glm::length(mars::to_camera(from, ground_.radius_m).position_m - *point);
  go(platform_of(looking_at(from, *point, distance_m * kDoubleClick, ground_)));
}

}  // namespace vpe::explore
