// A space mouse (a cap that can be pushed and turned in all six degrees of freedom), as controls and actions.
//
// The cap is the camera: pushed right, up or away it moves so; tilted back it looks up, turned clockwise (seen
// from above) it looks right, tilted right it rolls right.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/device_error.h"

namespace vpe::explore {

// As spacenavd tells them: about -350..350 each. move: right, up, away from the hand. turn, about those axes:
// tilted back, counterclockwise from above, tilted right.
struct SpaceMouseMotion {
  std::array<int, 3> move{};
  std::array<int, 3> turn{};
};

struct SpaceMouseButton {
  int number = 0;  // from 0
  bool is_down = false;
};

// The mouse, or the daemon that speaks for it, is gone.
struct SpaceMouseGone {};

using SpaceMouseEvent = std::variant<SpaceMouseMotion, SpaceMouseButton, SpaceMouseGone>;

class SpaceMouseSource {
 public:
  virtual ~SpaceMouseSource() = default;
  // Events since the last call, oldest first. Never waits, never throws.
  virtual std::vector<SpaceMouseEvent> poll() = 0;
};

struct SpaceMouseOptions {
  static constexpr double kFull = 350;  // of an event: a cap pushed as far as it goes
  static constexpr double kMaxDeadZone = 0.9;
  static constexpr double kMinCurve = 1;
  static constexpr double kMaxCurve = 5;

  double dead_zone = 0.05;    // share of the way, of each axis
  double curve = 1.5;         // power: 1 = straight, more = finer near rest
  bool holds_ground = false;  // the cap is the ground instead of the camera: everything the other way round
  bool roll = true;           // off: the horizon stays level

  bool operator==(const SpaceMouseOptions&) const = default;
};

// Pure.
Controls space_mouse_controls(const SpaceMouseMotion& motion, const SpaceMouseOptions& options);

struct SpaceMouseReading {
  Controls controls;
  std::vector<Action> actions;  // button 0: level, button 1: north up, straight down
};

// From frame to frame. Motion lasts until the next event: spacenavd tells when the cap is back at rest. For the
// case that it never does, motion ends after kTimeout_s without an event, and at once with SpaceMouseGone.
class SpaceMouse {
 public:
  static constexpr double kTimeout_s = 2;

  // Times are seconds of one clock.
  SpaceMouseReading read(std::span<const SpaceMouseEvent> events, const SpaceMouseOptions& options,
                         double time_s);

 private:
  SpaceMouseMotion motion_;
  double moved_s_ = 0;
  std::vector<int> down_;
};

// spacenavd by libspnav: at $SPNAV_SOCKET, where /etc/spnavrc says, or at /var/run/spnav.sock. May wait for 0.3
// s for an old daemon's answer. Throws DeviceError when there is none, when one is open already (libspnav has
// one connection a process) and when vpe was built without libspnav. The process must ignore SIGPIPE.
std::unique_ptr<SpaceMouseSource> open_space_mouse();

}  // namespace vpe::explore
