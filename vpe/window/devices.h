// Input devices, polled once a frame: keyboard, gamepad, space mouse, head tracker.
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
#include "vpe/window/panels/devices_panel.h"
#include "vpe/window/ui/display.h"

namespace vpe::window {

// Sources of device states. Tests replace them.
struct DeviceSources {
  std::function<std::optional<explore::PadState>()> pad;   // default: the first that GLFW finds
  std::function<std::string()> pad_name;                   // default: as GLFW calls that one
  std::unique_ptr<explore::SpaceMouseSource> space_mouse;  // default: spacenavd, if it runs
};

struct DeviceReading {
  explore::Controls controls;
  mars::HeadAngles look;
  explore::HeadPlace head;  // `look` again, and where the head is
  std::vector<explore::Action> actions;
};

// Combines the input of all devices. For the window's thread.
//
// Typical usage:
//   for (const Event& event : display.events(wait_s)) devices.key(event);
//   const DeviceReading input = devices.read(time_s, ImGui::GetIO().WantTextInput);
//   session.advance(dt_s, input.controls, input.look);
class Devices {
 public:
  Devices(const explore::Preferences& preferences, DeviceSources sources);

  // Uses other preferences from now on; opens and closes devices as they say. Returns why devices could not be opened.
  std::vector<std::string> use(const explore::Preferences& preferences, double time_s);

  // Processes a key event.
  void key(const Event& event);
  void lose_keyboard() { held_.clear(); }

  // Reads all devices. typing: a text field has the focus, so keys are ignored. Times are seconds of one clock.
  // Keys have their meaning in `mode`.
  DeviceReading read(double time_s, bool typing, explore::MotionMode mode = explore::MotionMode::kOrbit);

  // Returns true if a device must be polled because it sends no events.
  bool polls(double time_s) const;
  void recentre(double time_s) { tracker_.recentre(time_s); }
  // Returns what the devices said at the last read().
  DeviceStates states(double time_s) const;
  // Returns why devices could not be opened.
  const std::vector<std::string>& errors() const { return errors_; }
  // Returns the port for the head tracker's datagrams, or nullopt if it is off.
  std::optional<int> tracker_port() const;

 private:
  void open_devices();

  explore::Preferences preferences_;
  DeviceSources sources_;
  explore::KeySet held_;
  explore::Modifiers with_;
  std::vector<explore::KeyPress> presses_;
  explore::Gamepad gamepad_;
  explore::SpaceMouse space_mouse_;
  explore::HeadTracker tracker_;
  std::unique_ptr<explore::UdpReceiver> receiver_;
  std::optional<explore::PadState> pad_;  // at the last read()
  explore::Controls pad_controls_;
  explore::Controls cap_controls_;
  std::vector<std::string> errors_;
};

}  // namespace vpe::window
