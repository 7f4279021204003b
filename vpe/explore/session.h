// One exploration: where the camera is and where it goes, what is set, and what a mouse is doing. Knows no window
// and no clock: it is told what devices say and how much time has passed.
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
  std::optional<mars::Pose> start;  // left out: the whole planet
  double fov_deg = 50;
  std::vector<core::InterestRegion> interest;
  double mouse_speed = 1;     // factor on what a drag turns and tilts
  bool invert_wheel = false;  // rolling away goes away
};

enum class MouseUse : std::uint8_t { kNone, kHold, kTilt };

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
  double height_m() const;  // of the camera above the ground
  // What the camera sees: pose, head and screen.
  core::View view() const;

  // While a flight is followed: the flight's too, and over them what was set since.
  const core::Settings& settings() const { return shown_settings_; }
  // What is wrong, empty when all is well. The ground follows the exaggeration.
  std::string set(std::string_view key, std::string_view text);
  std::span<const core::InterestRegion> interest() const { return interest_; }  // without a flight's own
  std::vector<core::InterestRegion> all_interest();
  void set_interest(std::vector<core::InterestRegion> regions);
  // Counts what changed besides the view: settings, regions.
  std::uint64_t changes() const { return changes_; }

  void resize(int width, int height);
  void set_fov(double fov_deg);

  // At once; ends a flight to somewhere.
  void put(const mars::Pose& pose);
  // Flies there.
  void go(const mars::Pose& pose);
  bool is_going() const { return going_.has_value(); }
  void stop() { going_.reset(); }
  // Flies to a place with what is seen from here: the same height above ground, heading and pitch; from farther
  // out than a radius, down to half a radius.
  void go_to(mars::LonLat place);
  void north_up() { go_turned(0, pose_.pitch_deg, pose_.roll_deg); }
  void level() { go_turned(pose_.yaw_deg, pose_.pitch_deg, 0); }
  // Straight down on what is in the middle of the image, from as far away; perhaps with north up.
  void look_down(bool north_up);
  // The whole planet from above where the camera is.
  void show_planet();

  // The flight: edited here, played by follow(). While it is followed the camera is its platform's, and drags and
  // turns look around in it without disturbing it; moving by hand while it is paused leaves it.
  FlightController& flights() { return flights_; }
  const FlightController& flights() const { return flights_; }
  FlightPlayer* player() { return flights_.player(shown_settings_.values().exaggeration); }
  bool follows_flight() const { return follows_; }
  // Plays (or shows, paused). What is wrong, empty when all is well.
  std::string follow(bool play);
  void leave_flight();
  void scrub(double time_s);

  // A frame: what hands ask for, and where a tracker says that the head looks.
  void advance(double dt_s, const Controls& controls, const mars::HeadAngles& tracker = {});

  // Positions on the screen, of what is seen there: with the head on its platform. A press ends a flight to
  // somewhere.
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
  void go_turned(double yaw_deg, double pitch_deg, double roll_deg);
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
  mars::HeadAngles begun_look_;  // when the button was pressed, in a flight
  mars::Pose begun_;             // what was seen when the button was pressed
  glm::dvec2 begun_xy_{0, 0};
  std::optional<glm::dvec3> held_m_;  // ground under it then
};

}  // namespace vpe::explore
