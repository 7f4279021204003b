#include "vpe/explore/input/keyboard.h"

#include <algorithm>
#include <array>

namespace vpe::explore {

namespace {

using C = Controls;
using A = ActionKind;

constexpr std::array kHeld{
    HeldBinding{Key::kW, &C::forward, 1, "forward"},
    HeldBinding{Key::kS, &C::forward, -1, "back"},
    HeldBinding{Key::kA, &C::right, -1, "left"},
    HeldBinding{Key::kD, &C::right, 1, "right"},
    HeldBinding{Key::kE, &C::up, 1, "up"},
    HeldBinding{Key::kQ, &C::up, -1, "down"},
    HeldBinding{Key::kPageUp, &C::up, 1, "up"},
    HeldBinding{Key::kPageDown, &C::up, -1, "down"},
    HeldBinding{Key::kSpace, &C::up, 1, "fly: up", MotionMode::kFly},
    HeldBinding{Key::kLeft, &C::yaw_right, -1, "turn left"},
    HeldBinding{Key::kRight, &C::yaw_right, 1, "turn right"},
    HeldBinding{Key::kUp, &C::pitch_up, 1, "turn up"},
    HeldBinding{Key::kDown, &C::pitch_up, -1, "turn down"},
    HeldBinding{Key::kComma, &C::roll_right, -1, "roll left"},
    HeldBinding{Key::kPeriod, &C::roll_right, 1, "roll right"},
};

constexpr Modifiers kAlone{};
constexpr Modifiers kCtrl{.ctrl = true};
constexpr Modifiers kAlt{.alt = true};
constexpr Modifiers kShift{.shift = true};
// Most keyboards need Shift for a +.
constexpr Chord kTypedPlus{Key::kPlus, kShift};
constexpr Chord kTypedCtrlPlus{Key::kPlus, {.ctrl = true, .shift = true}};

std::vector<PressedBinding> make_pressed() {
  std::vector<PressedBinding> all{
      {{Key::kN, kAlone}, {A::kNorthUp}},
      {{Key::kU, kAlone}, {A::kLookDown}},
      {{Key::kG, kAlone}, {A::kLevel}},
      {{Key::kR, kAlone}, {A::kReset}},
      {{Key::kHome, kAlone}, {A::kWholePlanet}},
      {{Key::kBackspace, kAlone}, {A::kViewBack}},
      {{Key::kLeft, kAlt}, {A::kViewBack}},
      {{Key::kBackspace, kShift}, {A::kViewForward}},
      {{Key::kRight, kAlt}, {A::kViewForward}},
      {{Key::kPlus, kAlone}, {A::kZoomIn}},
      {kTypedPlus, {A::kZoomIn}},
      {{Key::kMinus, kAlone}, {A::kZoomOut}},
      {{Key::k0, kAlone}, {A::kZoomReset}},
      {{Key::kO, kAlone}, {A::kOrthographic}},
      {{Key::kF, kAlone}, {A::kNextMode}},
      {{Key::kF, kShift}, {A::kPreviousMode}},
      {{Key::kX, kAlone}, {A::kCatchCursor}},
      {{Key::kB, kAlone}, {A::kSwipe}},
      {{Key::kLeftBracket, kAlone}, {A::kSwipeLeft}},
      {{Key::kRightBracket, kAlone}, {A::kSwipeRight}},
      {{Key::kSpace, kAlone}, {A::kPlayPause}},
      {{Key::kL, kAlone}, {A::kRecord}},
      {{Key::kP, kAlone}, {A::kPlaceWaypoint}},
      {{Key::kM, kAlone}, {A::kMeasure}},
      {{Key::kEnter, kAlone}, {A::kEnterOverlook}},
      {{Key::kEscape, kAlone}, {A::kLeave}},
      {{Key::kC, kAlone}, {A::kRecentreHead}},
      {{Key::kTab, kAlone}, {A::kMap}},
      {{Key::kH, kAlone}, {A::kHidePanels}},
      {{Key::kF11, kAlone}, {A::kFullScreen}},
      {{Key::kPlus, kCtrl}, {A::kLettersLarger}},
      {kTypedCtrlPlus, {A::kLettersLarger}},
      {{Key::kMinus, kCtrl}, {A::kLettersSmaller}},
      {{Key::k0, kCtrl}, {A::kLettersUsual}},
      {{Key::kF12, kAlone}, {A::kScreenshot}},
      {{Key::kSlash, kAlone}, {A::kSearch}},
      {{Key::kF, kCtrl}, {A::kSearch}},
      {{Key::kO, kCtrl}, {A::kFiles}},
      {{Key::kC, kCtrl}, {A::kCopy}},
      {{Key::kF1, kAlone}, {A::kHelp}},
      {{Key::kF6, kAlone}, {A::kPanelKeys}},
  };
  for (int number = 1; number <= Action::kMaxBookmark; ++number) {
    const auto key = static_cast<Key>(static_cast<int>(Key::k0) + number);
    all.push_back({{key, kAlone}, {A::kGoToBookmark, number}});
    all.push_back({{key, kCtrl}, {A::kSetBookmark, number}});
  }
  return all;
}

const std::vector<PressedBinding>& pressed() {
  static const std::vector<PressedBinding> all = make_pressed();
  return all;
}

bool acts_in(const HeldBinding& binding, MotionMode mode) { return !binding.mode || *binding.mode == mode; }

// Arrows with Alt go through the history of views, and keys of turning up and down must not differ from them.
bool is_pressed_with_alt(Key key) {
  return key == Key::kLeft || key == Key::kRight || key == Key::kUp || key == Key::kDown;
}

// Returns the keys of one kind of action; numbered keys as first and last.
std::string keys_of(const ActionInfo& action) {
  std::vector<std::string> keys;
  for (const PressedBinding& binding : pressed()) {
    const bool is_typed = binding.chord == kTypedPlus || binding.chord == kTypedCtrlPlus;
    if (binding.action.kind == action.kind && !is_typed) keys.push_back(name(binding.chord));
  }
  if (keys.empty()) return "";
  if (action.is_numbered) return keys.front() + " ... " + keys.back();
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : ", ") + key;
  return text;
}

}  // namespace

std::span<const HeldBinding> held_bindings() { return kHeld; }
std::span<const PressedBinding> pressed_bindings() { return pressed(); }

Controls keyboard_controls(const KeySet& held, const Modifiers& with, MotionMode mode) {
  Controls controls;
  if (with.ctrl) return controls;
  for (const HeldBinding& binding : kHeld) {
    const bool acts = acts_in(binding, mode) && !(with.alt && is_pressed_with_alt(binding.key));
    if (acts && held.has(binding.key)) controls.*binding.rate += binding.value;
  }
  for (double Controls::*rate : {&C::right, &C::up, &C::forward, &C::yaw_right, &C::pitch_up, &C::roll_right})
    controls.*rate = std::clamp(controls.*rate, -1.0, 1.0);
  if (with.shift) controls.speed *= KeyboardOptions::kFaster;
  if (with.alt) controls.speed *= KeyboardOptions::kSlower;
  return controls;
}

std::vector<Action> keyboard_actions(std::span<const KeyPress> presses, MotionMode mode) {
  std::vector<Action> all;
  for (const KeyPress& press : presses) {
    const auto found =
        std::find_if(pressed().begin(), pressed().end(),
                     [&press](const PressedBinding& binding) { return binding.chord == press.chord; });
    if (found == pressed().end()) continue;
    const bool is_held = std::any_of(kHeld.begin(), kHeld.end(), [&](const HeldBinding& binding) {
      return binding.mode == mode && binding.key == press.chord.key && press.chord.with == kAlone;
    });
    if (is_held) continue;
    if (press.is_repeat && !info(found->action.kind).repeats) continue;
    all.push_back(found->action);
  }
  return all;
}

std::vector<HelpLine> keyboard_help() {
  std::vector<HelpLine> lines;
  for (const HeldBinding& binding : kHeld)
    lines.push_back({std::string(name(binding.key)), std::string(binding.meaning)});
  lines.push_back({"Shift, Alt", "move faster, slower"});
  for (const ActionInfo& action : actions()) {
    if (std::string keys = keys_of(action); !keys.empty())
      lines.push_back({std::move(keys), std::string(action.meaning)});
  }
  return lines;
}

std::string keyboard_help_text() {
  const std::vector<HelpLine> lines = keyboard_help();
  std::size_t width = 0;
  for (const HelpLine& line : lines) width = std::max(width, line.keys.size());
  std::string text;
  for (const HelpLine& line : lines) {
    text += line.keys + std::string(width + 2 - line.keys.size(), ' ') + line.meaning + "\n";
  }
  return text;
}

}  // namespace vpe::explore
