// Devices: what is connected, what it says at the moment, and its preferences.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/explore/files/preferences.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/gamepad.h"
#include "vpe/window/panels/preferences_panel.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

struct ShownPad {
  std::string name;
  std::array<std::uint8_t, explore::kPadButtons> buttons{};
  std::array<float, explore::kPadAxes> axes{};
  explore::Controls controls;  // that it makes

  bool operator==(const ShownPad&) const = default;
};

struct ShownTracker {
  int port = 0;
  bool is_live = false;  // datagrams come
  mars::HeadAngles look;
  std::uint64_t received = 0;
  std::uint64_t ignored = 0;  // datagrams that are not a head's

  bool operator==(const ShownTracker& other) const {
    return port == other.port && is_live == other.is_live && look.yaw_deg == other.look.yaw_deg &&
           look.pitch_deg == other.look.pitch_deg && look.roll_deg == other.look.roll_deg &&
           received == other.received && ignored == other.ignored;
  }
};

// Describes the devices at a moment.
struct DeviceStates {
  std::optional<ShownPad> pad;
  std::optional<explore::Controls> space_mouse;  // nullopt: its daemon is not connected
  std::optional<ShownTracker> tracker;           // nullopt: nobody listens
  std::vector<std::string> errors;               // why devices could not be opened

  bool operator==(const DeviceStates&) const = default;
};

// Draws the panel in the present ImGui window: a part for each device, with its rows of preferences.
PreferencesActions draw_devices_panel(const DeviceStates& states, const explore::Preferences& preferences,
                                      Widgets& widgets);

}  // namespace vpe::window
