// Converts events of a space mouse (a cap with six degrees of freedom) to controls and actions.
//
// The cap controls the camera: pushing it moves the camera in the same direction; tilting it back looks up,
// rotating it clockwise (seen from above) looks right, tilting it right rolls right.
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

namespace vpe::explore {

// Holds a deflection as spacenavd reports it, about -350..350 each.
struct SpaceMouseMotion {
  std::array<int, 3> move{};    // right, up, away from the hand
  std::array<int, 3> rotate{};  // tilted back, counterclockwise from above, tilted right
};

struct SpaceMouseButton {
  int number = 0;  // from 0
  bool is_down = false;
};

// The mouse was unplugged, or the connection to its daemon was lost.
struct SpaceMouseGone {};

using SpaceMouseEvent = std::variant<SpaceMouseMotion, SpaceMouseButton, SpaceMouseGone>;

// Delivers events of a space mouse.
class SpaceMouseSource {
 public:
  virtual ~SpaceMouseSource() = default;
  // Returns the events since the last call, oldest first. Never waits, never throws.
  virtual std::vector<SpaceMouseEvent> poll() = 0;
};

struct SpaceMouseOptions {
  static constexpr double kFull = 350;  // an event's value at full deflection
  static constexpr double kMaxDeadZone = 0.9;
  static constexpr double kMinCurve = 1;
  static constexpr double kMaxCurve = 5;

  double dead_zone = 0.05;    // share of each axis. Smaller: reacts sooner; larger: no drift of worn caps.
  double curve = 1.5;         // power: 1 = linear; larger: finer near rest, steeper at the end
  bool holds_ground = false;  // the cap controls the ground instead of the camera: all signs are reversed
  bool roll = true;           // false: the horizon stays level

  bool operator==(const SpaceMouseOptions&) const = default;
};

// Converts a deflection to controls. Pure.
Controls space_mouse_controls(const SpaceMouseMotion& motion, const SpaceMouseOptions& options);

struct SpaceMouseReading {
  Controls controls;
  std::vector<Action> actions;  // button 0: level, button 1: north up, straight down
};

// Processes events frame by frame. Motion lasts until the next event, since spacenavd reports when the cap is
// back at rest. If it does not, motion ends after kTimeout_s without an event, and immediately with
// SpaceMouseGone. For one thread at a time.
//
// Typical usage:
//   const auto source = open_space_mouse();
//   const SpaceMouseReading reading = mouse.read(source->poll(), options, time_s);   // in each frame
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

// Connects to spacenavd by libspnav: at $SPNAV_SOCKET, at the socket named in /etc/spnavrc, or at
// /var/run/spnav.sock. May wait up to 0.3 s for the answer of an old daemon. Throws DeviceError if there is no
// daemon, if a connection is open already (libspnav has one for each process), and if vpe was built without
// libspnav. The process must ignore SIGPIPE.
std::unique_ptr<SpaceMouseSource> open_space_mouse();

}  // namespace vpe::explore
