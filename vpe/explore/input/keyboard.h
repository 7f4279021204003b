// Key bindings, and functions that convert keys to controls and actions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/keys.h"
#include "vpe/explore/input/motion_mode.h"

namespace vpe::explore {

// Describes a key that acts while it is held. With Ctrl none does, so that Ctrl + letter never moves; with Alt those
// of the arrows do not.
struct HeldBinding {
  Key key;
  double Controls::*rate;
  double value;  // of the rate, -1 or 1
  std::string_view meaning;
  std::optional<MotionMode> mode = std::nullopt;  // in which it acts; nullopt: all
};

// Describes a key that acts when it goes down with exactly these modifiers.
struct PressedBinding {
  Chord chord;
  Action action;
};

// Return the tables. No chord has two meanings in a mode: a held key of all modes occurs in pressed chords only with
// Alt, and one of a single mode has its meaning instead of that of a pressed chord.
std::span<const HeldBinding> held_bindings();
std::span<const PressedBinding> pressed_bindings();

struct KeyboardOptions {
  static constexpr double kFaster = 4;     // Shift: factor on motion
  static constexpr double kSlower = 0.25;  // Alt
};

// Converts held keys to controls. Opposite keys cancel each other, and two keys of one direction count once.
Controls keyboard_controls(const KeySet& held, const Modifiers& with, MotionMode mode = MotionMode::kOrbit);

// Describes a key that went down, or that the system repeats while it is held.
struct KeyPress {
  Chord chord;
  bool is_repeat = false;
};

// Converts presses to actions, in their order. Repeats count only for actions that repeat.
std::vector<Action> keyboard_actions(std::span<const KeyPress> presses, MotionMode mode = MotionMode::kOrbit);

// Describes a line of the help panel, for example "1 ... 9" and the meaning.
struct HelpLine {
  std::string keys;
  std::string meaning;
};

// Returns the lines of the help panel, held keys first.
std::vector<HelpLine> keyboard_help();
// Returns the same as text in two columns.
std::string keyboard_help_text();

}  // namespace vpe::explore
