// A gamepad, as controls and actions.
//
// Left stick moves right and forward, right stick turns, triggers sink (left) and climb (right), bumpers roll;
// the left stick pressed moves faster, the right one slower. Other buttons are pressed_buttons().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"

namespace vpe::explore {

// Numbers as in the standard mapping of GLFW 3.3 (and SDL): the names are of an Xbox pad.
enum class PadButton {
  kA,
  kB,
  kX,
  kY,
  kLeftBumper,
  kRightBumper,
  kBack,
  kStart,
  kGuide,
  kLeftStick,
  kRightStick,
  kUp,
  kRight,
  kDown,
  kLeft,
};
inline constexpr std::size_t kPadButtons = 15;

enum class PadAxis { kLeftX, kLeftY, kRightX, kRightY, kLeftTrigger, kRightTrigger };
inline constexpr std::size_t kPadAxes = 6;

// Sticks -1..1, right and *down* positive; triggers -1 (rest) to 1. The same members as GLFWgamepadstate.
struct PadState {
  std::array<std::uint8_t, kPadButtons> buttons{};  // 0 = up
  std::array<float, kPadAxes> axes{0, 0, 0, 0, -1, -1};

  bool is_down(PadButton button) const { return buttons[static_cast<std::size_t>(button)] != 0; }
  float axis(PadAxis axis) const { return axes[static_cast<std::size_t>(axis)]; }
};

struct PadOptions {
  static constexpr double kMaxDeadZone = 0.9;
  static constexpr double kMinCurve = 1;
  static constexpr double kMaxCurve = 5;
  static constexpr double kFaster = 4;
  static constexpr double kSlower = 0.25;

  double dead_zone = 0.15;         // of the sticks, share of their way, round
  double trigger_dead_zone = 0.1;  // of the triggers
  double curve = 2;                // power: 1 = straight, more = finer near rest
  bool invert_pitch = false;       // right stick up looks down

  bool operator==(const PadOptions&) const = default;
};

// Axes that are not finite are at rest. Pure.
Controls pad_controls(const PadState& state, const PadOptions& options);

struct PadBinding {
  PadButton button;
  Action action;
};
std::span<const PadBinding> pad_bindings();

struct PadReading {
  Controls controls;
  std::vector<Action> actions;
};

// One pad from frame to frame. One thread at a time.
class Gamepad {
 public:
  // The state now; nothing = no pad is plugged in, which is rest. A button that is down when the pad comes is
  // not pressed. A trigger that says exactly 0 has told nothing since the pad came (some drivers begin so): it
  // is at rest.
  PadReading read(const std::optional<PadState>& state, const PadOptions& options);

 private:
  std::optional<PadState> before_;
  std::array<bool, 2> has_told_{};
};

}  // namespace vpe::explore
