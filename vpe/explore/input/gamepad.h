// Converts the state of a gamepad to controls and actions.
//
// Left stick moves right and forward, right stick rotates, triggers sink (left) and climb (right), bumpers
// roll. Pressing the left stick moves faster, the right one slower. Other buttons are in pad_bindings().
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

// Numbers of the standard mapping of GLFW 3.3 (and SDL); the names are those of an Xbox pad.
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

// Holds the same members as GLFWgamepadstate. Sticks are -1..1, right and *down* positive; triggers -1 (rest)
// to 1.
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

  // Shares of the deflection. Smaller: reacts sooner, but worn sticks drift; larger: the reverse.
  double dead_zone = 0.15;         // of the sticks, round
  double trigger_dead_zone = 0.1;  // of the triggers
  double curve = 2;                // power: 1 = linear; larger: finer near rest, steeper at the end
  bool invert_pitch = false;       // right stick up looks down

  bool operator==(const PadOptions&) const = default;
};

// Converts a state to controls. Axes that are not finite count as at rest. Pure.
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

// Detects presses from frame to frame. For one thread at a time.
class Gamepad {
 public:
  // Processes the present state; nullopt = no pad is plugged in, which counts as rest. A button that is down
  // when the pad is plugged in does not count as pressed. Some drivers report 0 for a trigger until it is
  // touched: a trigger that has reported nothing but 0 since the pad was plugged in counts as at rest.
  PadReading read(const std::optional<PadState>& state, const PadOptions& options);

 private:
  std::optional<PadState> before_;
  std::array<bool, 2> has_reported_{};
};

}  // namespace vpe::explore
