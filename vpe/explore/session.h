// An interactive session: camera and its motion, settings, mouse drags, the flight. Independent of windows and
// clocks: the caller passes inputs of devices and elapsed time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/pose.h"
#include "paging/surface/surface.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/interest.h"
#include "vpe/core/view.h"
#include "vpe/explore/flight_controller.h"
#include "vpe/explore/fly_to.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/mouse.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct SessionOptions {
  core::Settings settings;
  std::optional<mars::Pose> start;  // nullopt: the whole planet
  double fov_deg = 50;
  std::vector<core::InterestRegion> interest;
  double mouse_speed = 1;     // factor on rotation and tilt by a drag
  bool invert_wheel = false;  // rolling away zooms out
};

enum class MouseUse : std::uint8_t { kNone, kHold, kTilt };

// Holds the state of a session. For one thread at a time.
//
// Typical usage, in each iteration of the event loop:
//   session.resize(width, height);
//   session.press(MouseUse::kHold, xy);              // on mouse events
//   session.advance(dt_s, controls, head_angles);
//   draw(session.view(), session.settings());
class Session {
 public:
  static constexpr double kMinFov_deg = 1;
  static constexpr double kMaxFov_deg = 140;

  Session(std::shared_ptr<const paging::Surface> surface, const SessionOptions& options);

  const mars::Pose& pose() const { return pose_; }
  const mars::HeadAngles& look() const { return look_; }
  const Screen& screen() const { return screen_; }
  const TerrainQuery& ground() const { return ground_; }
  const paging::Surface& surface() const { return *surface_; }
  // Uses another surface of the same body from now on. The camera stays, but above the ground.
  void set_surface(std::shared_ptr<const paging::Surface> surface);
  double height_m() const;  // of the camera above the ground
  // Returns the view of the camera: pose, head and screen.
  core::View view() const;

  // Returns the settings in effect. While a flight is followed they include the flight's, and the user's
  // changes since then.
  const core::Settings& settings() const { return shown_settings_; }
  // Sets a setting. Returns what is wrong, or "". The ground follows the exaggeration.
  std::string set(std::string_view key, std::string_view text);
  std::span<const core::InterestRegion> interest() const { return interest_; }  // without the flight's
  std::vector<core::InterestRegion> all_interest();
  void set_interest(std::vector<core::InterestRegion> regions);
  // Counts changes of settings and regions.
  std::uint64_t changes() const { return changes_; }

  void resize(int width, int height);
  void set_fov(double fov_deg);

  // Moves the camera to a pose at once and ends an automatic flight.
  void put(const mars::Pose& pose);
  // Begins an automatic flight to a pose.
  void go(const mars::Pose& pose);
  bool is_going() const { return going_.has_value(); }
  void stop() { going_.reset(); }
  // Flies to a place with the same height above ground, heading and pitch. From farther than a planet's radius,
  // flies down to half a radius.
  void go_to(mars::LonLat place);
  void north_up() { go_rotated(0, pose_.pitch_deg, pose_.roll_deg); }
  void level() { go_rotated(pose_.yaw_deg, pose_.pitch_deg, 0); }
  // Flies straight above the ground in the middle of the image, at the same distance; optionally with north up.
  void look_down(bool north_up);
  // Flies above the present place until the whole planet is in the image.
  void show_planet();

  // Gives access to the flight: edited here, played by follow(). While it is followed, the camera is on its
  // platform, and drags and rotations add to its look without disturbing it. Moving by hand while it is paused
  // leaves it.
  FlightController& flights() { return flights_; }
  const FlightController& flights() const { return flights_; }
  FlightPlayer* player() { return flights_.player(shown_settings_.values().exaggeration); }
  bool follows_flight() const { return follows_; }
  // Plays the flight, or shows it paused. Returns what is wrong, or "".
  std::string follow(bool play);
  void leave_flight();
  void scrub(double time_s);

  // Advances by one frame. `tracker` is the direction of the head by a head tracker.
  void advance(double dt_s, const Controls& controls, const mars::HeadAngles& tracker = {});

  // Handle mouse input. Positions are on the screen and refer to the image that is shown, which includes the
  // head's direction. A press ends an automatic flight.
  void press(MouseUse use, glm::dvec2 xy);
  void drag(glm::dvec2 xy);
  void release() { use_ = MouseUse::kNone; }
  MouseUse mouse_use() const { return use_; }
  void wheel(glm::dvec2 xy, double notches);
  void fly_towards(glm::dvec2 xy);  // double click

 private:
  mars::Pose seen() const;                               // the camera's, with the head
  mars::Pose platform_of(const mars::Pose& seen) const;  // its inverse
  double wheel_factor(double notches) const;
  void go_rotated(double yaw_deg, double pitch_deg, double roll_deg);
  void take_flight_state(const mars::HeadAngles& tracker);
  void follow_settings();

  std::shared_ptr<const paging::Surface> surface_;
  core::Settings settings_;        // the user's own
  core::Settings shown_settings_;  // with a flight's
  FlightController flights_;
  bool follows_ = false;
  mars::HeadAngles tracker_;
  TerrainQuery ground_;
  Screen screen_;
  mars::Pose pose_;
  mars::HeadAngles look_;
  std::vector<core::InterestRegion> interest_;
  double mouse_speed_ = 1;
  bool invert_wheel_ = false;
  std::uint64_t changes_ = 0;
  std::optional<FlyTo> going_;
  double gone_s_ = 0;
  MouseUse use_ = MouseUse::kNone;
  mars::HeadAngles begun_look_;  // look offset in a flight, when the button was pressed
  mars::Pose begun_;             // pose of the image, when the button was pressed
  glm::dvec2 begun_xy_{0, 0};
  std::optional<glm::dvec3> held_m_;  // ground under the cursor, when the button was pressed
};

}  // namespace vpe::explore
