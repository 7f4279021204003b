#include "vpe/explore/session.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "vpe/explore/steer.h"

namespace vpe::explore {

namespace {

constexpr double kSteepestEntry_deg = 10;  // downwards, of a view that begins to walk
constexpr double kHighestEntry_deg = 30;

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
      mouse_(options.mouse),
      mover_(options.vehicle) {
  use_ground();
  set_fov(options.fov_deg);
  pose_ = kept_clear(options.start ? *options.start : overview({0, 0}, screen_, ground_.radius_m), ground_);
}

void Session::set_surface(std::shared_ptr<const paging::Surface> surface) {
  surface_ = std::move(surface);
  flights_.set_terrain(terrain_height_of(surface_));
  use_ground();
  if (!follows_) pose_ = mover_.put(pose_, ground_);
  ++changes_;
}

void Session::set_changed_surface(std::shared_ptr<const paging::Surface> surface) {
  surface_ = std::move(surface);
  use_ground();
  if (!follows_) pose_ = mover_.put(pose_, ground_);
}

std::optional<mars::LonLat> Session::place_at(const core::View& shown, glm::dvec2 xy) const {
  const glm::dvec3 ray = core::pixel_ray(shown, xy.x, xy.y);
  const double range_m = ground_.cast_m(shown.camera.position_m, ray);
  if (!std::isfinite(range_m)) return std::nullopt;
  return mars::lon_lat(shown.camera.position_m + ray * range_m);
}

double Session::height_m() const { return height_above_ground_m(pose_, ground_); }

core::View Session::view() const {
  core::View view = view_of(pose_, screen_, ground_.radius_m);
  view.camera = mars::to_camera(pose_, look_, ground_.radius_m);
  return view;
}

mars::Pose Session::seen() const { return seen_of(pose_); }

mars::Pose Session::seen_of(const mars::Pose& platform) const {
  return is_ahead(look_) ? platform
                         : mars::to_pose(mars::to_camera(platform, look_, ground_.radius_m), ground_.radius_m);
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
  use_ground();
  if (!follows_) pose_ = mover_.put(pose_, ground_);
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
  if (!std::isfinite(fov_deg)) return;
  fov_deg_ =
      explore::is_orthographic(fov_deg) ? kOrthographicFov_deg : std::clamp(fov_deg, kMinFov_deg, kMaxFov_deg);
  if (!explore::is_orthographic(fov_deg_)) perspective_fov_deg_ = fov_deg_;
  if (FlightPlayer* flight = follows_ ? player() : nullptr; flight != nullptr) flight->keep_fov();
  follow_fov();
}

// Updates the field of view in effect: the user's, or that of a followed flight.
void Session::follow_fov() {
  FlightPlayer* flight = follows_ ? player() : nullptr;
  screen_.fov_deg = flight != nullptr ? flight->view().fov_deg.value_or(fov_deg_) : fov_deg_;
  ground_.highest_radii = highest_radii(screen_.fov_deg);
}

void Session::use_ground() {
  ground_ = ground_of(surface_, shown_settings_.values().exaggeration);
  ground_.highest_radii = highest_radii(screen_.fov_deg);
}

void Session::zoom(double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) return;
  if (follows_ || !is_orthographic()) return set_fov(std::max(kMinFov_deg, screen_.fov_deg * factor));
  stop();
  const mars::Pose from = seen();
  pose_ = platform_of(zoomed(from, screen_, {screen_.width / 2.0, screen_.height / 2.0}, factor, ground_));
}

std::string Session::set_orthographic(bool on) {
  if (on == is_orthographic()) return {};
  if (on) {
    leave_flight();
    if (mode() != MotionMode::kOrbit) set_mode(MotionMode::kOrbit);
  }
  stop();
  const double fov_deg = on ? kOrthographicFov_deg : perspective_fov_deg_;
  const std::optional<mars::Pose> pose = at_same_size(seen(), screen_, fov_deg, ground_);
  if (!pose) return "the middle of the view shows sky; look at the ground first";
  set_fov(fov_deg);
  pose_ = kept_clear(platform_of(*pose), ground_);
  return {};
}

// Turns about the ground in the middle: a camera that turned in place would lose it at once.
void Session::turn_orthographic(const Controls& controls, double dt_s) {
  const double turn_deg =
      SteerLimits::kRotation_deg_s * std::min(std::max(dt_s, 0.0), SteerLimits::kLongestStep_s);
  pose_ = platform_of(
      tilted(seen(), screen_, controls.yaw_right * turn_deg, -controls.pitch_up * turn_deg, ground_));
}

std::string Session::follow(bool play) {
  FlightPlayer* flight = player();
  if (flight == nullptr)
    return flights_.problem().empty() ? "there is no flight yet; place waypoints or open a flight"
                                      : flights_.problem();
  stop();
  leave_ground();
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
    flight->set_platform_offset({});
    flight->release_settings();
    flight->release_view();
  }
  follows_ = false;
  follow_settings();
  follow_fov();
  pose_ = kept_clear(pose_, ground_);
  look_ = tracker_;
}

void Session::scrub(double time_s) {
  FlightPlayer* flight = player();
  if (flight == nullptr) return;
  stop();
  leave_ground();
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
  follow_settings();
  follow_fov();
  pose_ = flight->platform_offset() == PlatformOffset{} ? state.pose : kept_clear(state.pose, ground_);
  look_ = added(state.head, tracker);
}

// Moves at the speed of a camera that flies by hand. Down ends at the ground: what lies below it is not added, so that
// a motion up takes effect at once.
void Session::move_platform(FlightPlayer& flight, const Controls& controls, double dt_s) {
  PlatformOffset offset = flight.platform_offset();
  const double step_m = full_speed_m_s(pose_, ground_) * controls.speed * dt_s;
  offset.right_m += controls.right * step_m;
  offset.up_m += controls.up * step_m;
  offset.forward_m += controls.forward * step_m;
  flight.set_platform_offset(offset);
  const mars::Pose pose = flight.state().pose;
  const double raised_m = kept_clear(pose, ground_).alt_m - pose.alt_m;
  if (controls.up != 0 && raised_m != 0) {
    offset.up_m += raised_m;
    flight.set_platform_offset(offset);
  }
}

void Session::stop() {
  going_.reset();
  throw_.reset();
  wheel_.reset();
  mover_.rest();
}

void Session::end_motion() {
  throw_.reset();
  if (wheel_) pose_ = wheel_->motion.to;
  wheel_.reset();
}

void Session::leave_ground() {
  if (mover_.is_on_ground()) mover_.set_mode(MotionMode::kOrbit);
  drive_look_ = {};
}

// Returns the pose as the mode holds it, and changes the mode for a pose high above the ground.
mars::Pose Session::stand_at(const mars::Pose& pose) {
  if (mover_.is_on_ground() && height_above_ground_m(pose, ground_) > kLeavesGround_m) leave_ground();
  return mover_.put(pose, ground_);
}

void Session::set_mode(MotionMode mode) {
  leave_flight();
  stop();
  if (mode == mover_.mode()) return;
  if (is_orthographic() && !set_orthographic(false).empty()) set_fov(perspective_fov_deg_);
  if (mover_.mode() == MotionMode::kDrive) {
    // The view stays, not the vehicle's attitude.
    pose_ = mars::to_pose(mars::to_camera(pose_, drive_look_, ground_.radius_m), ground_.radius_m);
    drive_look_ = {};
    look_ = tracker_;
  }
  mover_.set_mode(mode);
  if (!mover_.is_on_ground()) return;
  mars::Pose goal = pose_;
  goal.pitch_deg = std::clamp(goal.pitch_deg, -kSteepestEntry_deg, kHighestEntry_deg);
  goal.roll_deg = 0;
  begin_going(mover_.put(goal, ground_));
}

void Session::put(const mars::Pose& pose) {
  leave_flight();
  stop();
  pose_ = stand_at(pose);
}

void Session::go(const mars::Pose& pose) {
  leave_flight();
  stop();
  begin_going(stand_at(pose));
}

void Session::begin_going(const mars::Pose& goal) {
  going_.emplace(pose_, goal, ground_);
  gone_s_ = 0;
}

void Session::go_to(mars::LonLat place) {
  mars::Pose goal = pose_;
  goal.lon_deg = place.lon_deg;
  goal.lat_deg = place.lat_deg;
  if (is_orthographic()) {
    const mars::Pose from = seen();
    const auto shown_m = shown_height_m(from, screen_, ground_);
    if (!shown_m) return;
    goal.pitch_deg = -90;
    goal.roll_deg = 0;
    goal.alt_m = ground_.height_m(mars::direction(place)) +
                 *shown_m / (2.0 * std::tan(0.5 * screen_.fov_deg * mars::kRadiansPerDegree));
    return go(goal);
  }
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
      if (flight->is_playing()) {
        flight->advance(std::max(dt_s, 0.0));
        if (moves) move_platform(*flight, controls, dt);
      }
      take_flight_state(tracker);
      return;
    }
    leave_flight();
  }
  look_ = mode() == MotionMode::kDrive ? added(drive_look_, tracker) : tracker;
  if (any(controls)) {
    going_.reset();
    end_motion();
  }
  if (going_) {
    gone_s_ += std::max(dt_s, 0.0);
    pose_ = going_->at(gone_s_, ground_);
    if (gone_s_ >= going_->duration_s()) going_.reset();
    return;
  }
  if (go_on(std::max(dt_s, 0.0))) return;
  if (mode() == MotionMode::kDrive) {
    const double dt = std::min(std::max(dt_s, 0.0), SteerLimits::kLongestStep_s);
    drive_look_ = added(drive_look_, {controls.yaw_right * SteerLimits::kRotation_deg_s * dt,
                                      controls.pitch_up * SteerLimits::kRotation_deg_s * dt, 0});
    look_ = added(drive_look_, tracker);
  }
  if (is_orthographic() && mode() == MotionMode::kOrbit) {
    if (controls.yaw_right != 0 || controls.pitch_up != 0) turn_orthographic(controls, dt_s);
    Controls moved = controls;
    moved.yaw_right = moved.pitch_up = 0;
    // Across the line of sight the motion is that of a camera which is as far away as it seems; what is below the camera moves
    // less than the camera does.
    const double share = SteerLimits::kHighest_radii / ground_.highest_radii *
                         std::max(1.0, 1.0 + pose_.alt_m / ground_.radius_m);
    moved.right *= share;
    moved.up *= share;
    pose_ = mover_.advance(pose_, moved, dt_s, ground_);
    return;
  }
  pose_ = mover_.advance(pose_, controls, dt_s, ground_);
}

}  // namespace vpe::explore
