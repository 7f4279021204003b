#include "vpe/explore/flight_controller.h"

#include <limits>
#include <stdexcept>
#include <utility>

namespace vpe::explore {

FlightController::FlightController(double radius_m, scripts::TerrainHeight terrain_height_m)
    : radius_m_(radius_m), terrain_height_m_(std::move(terrain_height_m)) {}

void FlightController::set_terrain(scripts::TerrainHeight terrain_height_m) {
  terrain_height_m_ = std::move(terrain_height_m);
  player_exaggeration_ = std::numeric_limits<double>::quiet_NaN();  // player() makes it again
}

std::string FlightController::load(const scripts::Flight& flight) {
  try {
    FlightEditor editor(flight, radius_m_);
    FlightPlayer player(scripts::Path(flight, radius_m_, terrain_height_m_), radius_m_);
    editor_.emplace(std::move(editor));
    player_.emplace(std::move(player));
    ++loads_;
    player_revision_ = editor_->revision();
    player_exaggeration_ = 1;
    problem_.clear();
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

void FlightController::clear() {
  editor_.reset();
  ++loads_;
  player_.reset();
  problem_.clear();
}

std::string FlightController::append(const mars::Pose& pose, double speed_m_per_s) {
  scripts::Waypoint waypoint;
  waypoint.lon_deg = pose.lon_deg;
  waypoint.lat_deg = pose.lat_deg;
  waypoint.up_m = pose.alt_m;
  waypoint.yaw_deg = pose.yaw_deg;
  waypoint.pitch_deg = pose.pitch_deg;
  waypoint.roll_deg = pose.roll_deg;
  if (editor_) return editor_->append(waypoint, speed_m_per_s);
  scripts::Flight flight;
  flight.waypoints.push_back(waypoint);
  std::string problem = load(flight);
  if (problem.empty()) editor_->mark_unsaved();
  return problem;
}

FlightPlayer* FlightController::player(double exaggeration) {
  if (!editor_) return nullptr;
  if (player_revision_ == editor_->revision() && player_exaggeration_ == exaggeration)
    return player_ ? &*player_ : nullptr;
  player_revision_ = editor_->revision();
  player_exaggeration_ = exaggeration;
  std::optional<FlightPlayer> before = std::exchange(player_, std::nullopt);
  try {
    player_.emplace(scripts::Path(editor_->flight(), radius_m_, terrain_height_m_, exaggeration), radius_m_);
    problem_.clear();
  } catch (const std::runtime_error& e) {
    problem_ = e.what();
    return nullptr;
  }
  if (before) {
    player_->set_speed(before->speed());
    player_->set_loop(before->loops());
    player_->scrub(before->time_s());
    player_->set_look_offset(before->look_offset());
    player_->set_platform_offset(before->platform_offset());
    player_->keep_changes_of(*before);
    if (before->is_playing()) player_->play();
  }
  return &*player_;
}

}  // namespace vpe::explore
