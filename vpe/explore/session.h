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
#include "vpe/explore/drag_throw.h"
#include "vpe/explore/flight_controller.h"
#include "vpe/explore/fly_to.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/mouse_choices.h"
#include "vpe/explore/mouse.h"
#include "vpe/explore/mover.h"
#include "vpe/explore/orthographic.h"
#include "vpe/explore/terrain_query.h"
#include "vpe/explore/wheel_zoom.h"

namespace vpe::explore {

struct SessionOptions {
  core::Settings settings;
  std::optional<mars::Pose> start;  // nullopt: the whole planet
  double fov_deg = 50;
  std::vector<core::InterestRegion> interest;
  MouseChoices mouse;
  VehicleOptions vehicle;  // of the mode drive
};

// Says what a drag does: nothing, holds the ground under the cursor (over the sky, the sky), tilts and turns about the
// middle, looks around in place. In the modes fly, walk and drive every drag looks around.
enum class MouseUse : std::uint8_t { kNone, kHold, kTilt, kLook };

// Holds the state of a session. For one thread at a time.
//
// Typical usage, in each iteration of the event loop:
//   session.resize(width, height);
//   session.press(MouseUse::kHold, xy, event_s);     // on mouse events
//   session.advance(dt_s, controls, head_angles);
//   draw(session.view(), session.settings());
//   if (session.is_going() || session.is_moving()) another frame follows without input
class Session {
 public:
  static constexpr double kMinFov_deg = 1;
  static constexpr double kMaxFov_deg = 140;
  static constexpr double kLeavesGround_m = 20;

  Session(std::shared_ptr<const paging::Surface> surface, const SessionOptions& options);

  const mars::Pose& pose() const { return pose_; }
  const mars::HeadAngles& look() const { return look_; }
  const Screen& screen() const { return screen_; }
  const TerrainQuery& ground() const { return ground_; }
  const paging::Surface& surface() const { return *surface_; }
  // Uses another surface of the same body from now on. The camera stays, but above the ground.
  void set_surface(std::shared_ptr<const paging::Surface> surface);
  // Uses the surface of the same planet after its ground has changed, as images show it. The camera stays, but above the
  // ground. Flights keep their terrain, and no image is due because of it.
  void set_changed_surface(std::shared_ptr<const paging::Surface> surface);
  const std::shared_ptr<const paging::Surface>& shared_surface() const { return surface_; }
  double height_m() const;  // of the camera above the ground
  // Returns the view of the camera: pose, head and screen.
  core::View view() const;

  // Takes effect from the next mouse event on.
  void set_mouse(const MouseChoices& choices) { mouse_ = choices; }

  // Returns the ground that the view shows at a position of its image, or nullopt for the sky.
  std::optional<mars::LonLat> place_at(glm::dvec2 xy) const { return place_at(view(), xy); }
  // Returns likewise the ground in the image of another view, such as that of an eye.
  std::optional<mars::LonLat> place_at(const core::View& shown, glm::dvec2 xy) const;

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
  // Sets the field of view, within kMinFov_deg to kMaxFov_deg or that of the orthographic camera. In a flight that is followed it holds instead of the flight's, until the flight is left.
  void set_fov(double fov_deg);
  // Multiplies the field of view; with the orthographic camera the distance, and so what is seen, by the same factor.
  void zoom(double factor);

  // Returns whether the camera is the orthographic one (vpe/explore/orthographic.h).
  bool is_orthographic() const { return explore::is_orthographic(screen_.fov_deg); }
  // Takes the orthographic camera, or the former field of view again; the ground in the middle keeps its place and size. It
  // leaves a flight, and the modes fly, walk and drive. Motion by keys then turns about the middle, and moves by what is seen.
  // Returns what is wrong (the middle shows sky), or "".
  std::string set_orthographic(bool on);

  // Moves the camera to a pose at once and ends an automatic flight. In walk and drive, here and in go(), a pose is
  // put on the ground, but one more than kLeavesGround_m above it changes the mode to orbit.
  void put(const mars::Pose& pose);
  // Begins an automatic flight to a pose.
  void go(const mars::Pose& pose);
  bool is_going() const { return going_.has_value(); }
  // Returns true while the camera moves without input and without an automatic flight: after a throw, to the goal
  // of the wheel, by the momentum of the walker or the vehicle. Frames must follow until it is false.
  bool is_moving() const { return throw_.has_value() || wheel_.has_value() || mover_.is_moving(); }
  // Ends all motion at the present pose.
  void stop();

  // Returns how keys, mouse and wheel move the camera, and the speed factor, slope and vehicle of the mode.
  MotionMode mode() const { return mover_.mode(); }
  const Mover& mover() const { return mover_; }
  // Changes the mode and leaves a flight. Walk and drive fly down to the ground below the camera; the others begin
  // with the present view.
  void set_mode(MotionMode mode);

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
  // platform and has its field of view if it has one, and drags and rotations add to its look without disturbing
  // it. Moving while it plays adds to the platform's offset, which stays above the ground; moving by hand while it is
  // paused leaves it. Playing or scrubbing it changes walk and drive to orbit.
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
  // head's direction. A press ends an automatic flight and all motion. Times are seconds of one clock of the caller;
  // without them a drag throws nothing.
  void press(MouseUse use, glm::dvec2 xy, std::optional<double> time_s = std::nullopt);
  void drag(glm::dvec2 xy, std::optional<double> time_s = std::nullopt);
  void release(std::optional<double> time_s = std::nullopt);
  MouseUse mouse_use() const { return use_; }
  // Returns the ground that a drag holds, or tilts about, metres from the planet's centre; nullopt over the sky and
  // without a drag.
  std::optional<glm::dvec3> held_m() const { return use_ == MouseUse::kNone ? std::nullopt : held_m_; }
  // Moves the goal of the distance by 1.35 a notch; advance() reaches it within WheelLimits::kTime_s. In a flight,
  // walk and drive it changes the field of view, in fly the speed.
  void wheel(glm::dvec2 xy, double notches);
  void fly_towards(glm::dvec2 xy);  // double click
  // Looks around in place by a motion of a cursor that is caught: to the right and down are positive.
  void look_by(double dx_px, double dy_px);

 private:
  // Holds the motion to the goal of the wheel, and the cursor.
  struct Wheel {
    WheelMotion motion;
    glm::dvec2 xy{0, 0};
  };
  struct Throw {
    Motion motion;
    double time_s = 0;  // since the release
  };
  mars::Pose seen() const;                               // the camera's, with the head
  mars::Pose platform_of(const mars::Pose& seen) const;  // its inverse
  mars::Pose seen_of(const mars::Pose& platform) const;
  double signed_notches(double notches) const;
  void zoom_view(double notches);
  mars::Pose wheeled(const mars::Pose& from, glm::dvec2 xy, double factor);
  bool go_on(double dt_s);  // the wheel's motion or a throw; returns true if there is one
  void end_motion();        // of the throw and the wheel, at the wheel's goal
  mars::Pose stand_at(const mars::Pose& pose);
  void leave_ground();
  void begin_going(const mars::Pose& goal);
  void look_around(double yaw_deg, double pitch_deg);
  void go_rotated(double yaw_deg, double pitch_deg, double roll_deg);
  void take_flight_state(const mars::HeadAngles& tracker);
  void move_platform(FlightPlayer& flight, const Controls& controls, double dt_s);
  void follow_settings();
  void follow_fov();
  void use_ground();
  void turn_orthographic(const Controls& controls, double dt_s);

  std::shared_ptr<const paging::Surface> surface_;
  core::Settings settings_;        // the user's own
  core::Settings shown_settings_;  // with a flight's
  FlightController flights_;
  bool follows_ = false;
  double fov_deg_ = 50;              // the user's own; that of screen_ may be a flight's
  double perspective_fov_deg_ = 50;  // before the orthographic camera
  mars::HeadAngles tracker_;
  TerrainQuery ground_;
  Screen screen_;
  mars::Pose pose_;
  mars::HeadAngles look_;
  std::vector<core::InterestRegion> interest_;
  MouseChoices mouse_;
  Mover mover_;
  mars::HeadAngles drive_look_;  // of the driver, relative to the vehicle
  DragSamples samples_;
  std::optional<Throw> throw_;
  std::optional<Wheel> wheel_;
  std::optional<double> arrival_pitch_deg_;  // that the wheel gave last
  std::uint64_t changes_ = 0;
  std::optional<FlyTo> going_;
  double gone_s_ = 0;
  MouseUse use_ = MouseUse::kNone;
  mars::Pose begun_;                  // pose of the image, when the button was pressed
  glm::dvec2 begun_xy_{0, 0};         // where the button was pressed; in kLook, where the cursor was last
  std::optional<glm::dvec3> held_m_;  // ground under the cursor, or in kTilt in the middle, at the press
};

}  // namespace vpe::explore
