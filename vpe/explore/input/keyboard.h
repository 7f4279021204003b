// What keys do: tables, and pure functions of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/explore/input/actions.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/input/keys.h"

namespace vpe::explore {

// A key that works as long as it is held; with Alt it does not.
struct HeldBinding {
  Key key;
  double Controls::*rate;
  double value;  // of the rate, -1 or 1
  std::string_view meaning;
};

// A key that works when it goes down, with exactly these modifiers.
struct PressedBinding {
  Chord chord;
  Action action;
};

// No chord does two things: a held key is in no pressed chord but such with Alt.
std::span<const HeldBinding> held_bindings();
std::span<const PressedBinding> pressed_bindings();

struct KeyboardOptions {
  static constexpr double kFaster = 4;     // Shift: factor of moving
  static constexpr double kSlower = 0.25;  // Ctrl
};

// Opposite keys cancel each other.
Controls keyboard_controls(const KeySet& held, const Modifiers& with);

// A key that went down, or that the system repeats because it is held.
struct KeyPress {
  Chord chord;
  bool is_repeat = false;
};

// What the presses ask for, in their order. Of repeats only those of actions that repeat.
std::vector<Action> keyboard_actions(std::span<const KeyPress> presses);

// Lines of the help panel: keys ("1 ... 9") and what they do, held ones first.
struct HelpLine {
  std::string keys;
  std::string meaning;
};
std::vector<HelpLine> keyboard_help();
// The same as text, in two columns.
std::string keyboard_help_text();

}  // namespace vpe::explore
