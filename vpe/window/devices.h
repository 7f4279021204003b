// All that hands and heads are on, polled once a frame: keys, gamepad, space mouse, head tracker.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/explore/files/preferences.h"
#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/gamepad.h"
#include "vpe/explore/input/head_tracker.h"
#include "vpe/explore/input/keyboard.h"
#include "vpe/explore/input/space_mouse.h"
#include "vpe/explore/input/udp_receiver.h"
#include "vpe/window/display.h"

namespace vpe::window {

// Where devices come from; each may be replaced, as in tests.
struct DeviceSources {
  std::function<std::optional<explore::PadState>()> pad;   // default: the first that GLFW knows
  std::unique_ptr<explore::SpaceMouseSource> space_mouse;  // default: spacenavd, when it runs
};

struct DeviceReading {
  explore::Controls controls;
  mars::HeadAngles look;
  std::vector<explore::Action> actions;
};

class Devices {
 public:
  Devices(const explore::Preferences& preferences, DeviceSources sources);

  // Keys, as they come.
  void key(const Event& event);
  void lose_keyboard() { held_.clear(); }

  // typing: keys belong to a text field. Times are seconds of one clock.
  DeviceReading read(double time_s, bool typing);

  // Whether something must be polled though no event comes.
  bool polls(double time_s) const;
  void recentre(double time_s) { tracker_.recentre(time_s); }
  // What could not be opened, each told once.
  const std::vector<std::string>& troubles() const { return troubles_; }
  // Port of the head tracker's datagrams; nothing when it is off.
  std::optional<int> tracker_port() const;

 private:
  explore::Preferences preferences_;
  DeviceSources sources_;
  explore::KeySet held_;
  explore::Modifiers with_;
  std::vector<explore::KeyPress> presses_;
  explore::Gamepad gamepad_;
  explore::SpaceMouse space_mouse_;
  explore::HeadTracker tracker_;
  std::unique_ptr<explore::UdpReceiver> receiver_;
  bool pad_was_there_ = false;
  bool cap_moves_ = false;
  std::vector<std::string> troubles_;
};

}  // namespace vpe::window
