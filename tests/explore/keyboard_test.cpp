#include "vpe/explore/input/keyboard.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace vpe::explore {
namespace {

Controls held(std::initializer_list<Key> keys, const Modifiers& with = {}) {
  KeySet set;
  for (const Key key : keys) set.set(key);
  return keyboard_controls(set, with);
}

std::vector<Action> press(std::string_view chord, bool is_repeat = false) {
  const auto parsed = parse_chord(chord);
  EXPECT_TRUE(parsed.has_value()) << chord;
  const KeyPress one{parsed.value_or(Chord{}), is_repeat};
  return keyboard_actions(std::span(&one, 1));
}

TEST(Keys, NamesAreDifferentAndReadBack) {
  std::set<std::string_view> names;
  for (std::size_t n = 0; n < kKeyCount; ++n) {
    const Key key = static_cast<Key>(n);
    EXPECT_FALSE(name(key).empty()) << n;
    EXPECT_TRUE(names.insert(name(key)).second) << name(key);
    for (int bits = 0; bits < 8; ++bits) {
      const Chord chord{key, {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0}};
      EXPECT_EQ(parse_chord(name(chord)), chord) << name(chord);
    }
  }
  EXPECT_EQ(parse_chord("shift+ctrl+page up"), (Chord{Key::kPageUp, {.ctrl = true, .shift = true}}));
  EXPECT_EQ(parse_chord("Ctrl++"), (Chord{Key::kPlus, {.ctrl = true}}));
  for (const char* text : {"", "Ctrl", "Ctrl+", "Ctrl+Ctrl+A", "AA", "A+", "Hyper+A", " A"}) {
    EXPECT_FALSE(parse_chord(text).has_value()) << text;
  }
}

RC_GTEST_PROP(KeysProperty, AnyTextIsReadOrRejected, (const std::string& text)) {
  const auto chord = parse_chord(text);
  if (chord) RC_ASSERT(parse_chord(name(*chord)) == chord);
  const auto action = parse_action(text);
  if (action) RC_ASSERT(name(*action) == text);
}

TEST(Actions, NamesAreDifferentAndReadBack) {
  std::set<std::string> names;
  for (const ActionInfo& known : actions()) {
    const Action action{known.kind, known.is_numbered ? 7 : 0};
    EXPECT_TRUE(names.insert(name(action)).second) << name(action);
    EXPECT_EQ(parse_action(name(action)), action);
    EXPECT_FALSE(known.meaning.empty());
  }
  EXPECT_EQ(parse_action("set-bookmark 3"), (Action{ActionKind::kSetBookmark, 3}));
  for (const char* text :
       {"", "set-bookmark", "set-bookmark 0", "set-bookmark 10", "set-bookmark x", "help 1"}) {
    EXPECT_FALSE(parse_action(text).has_value()) << text;
  }
}

TEST(Keyboard, HeldKeysMoveAndRotate) {
  EXPECT_EQ(held({}), Controls{});
  EXPECT_EQ(held({Key::kW, Key::kD, Key::kE}), (Controls{.right = 1, .up = 1, .forward = 1}));
  EXPECT_EQ(held({Key::kS, Key::kA, Key::kQ}), (Controls{.right = -1, .up = -1, .forward = -1}));
  EXPECT_EQ(held({Key::kLeft, Key::kUp, Key::kPeriod}),
            (Controls{.yaw_right = -1, .pitch_up = 1, .roll_right = 1}));
  EXPECT_EQ(held({Key::kW, Key::kS}), Controls{});
  EXPECT_EQ(held({Key::kW}, {.shift = true}), (Controls{.forward = 1, .speed = KeyboardOptions::kFaster}));
  EXPECT_EQ(held({Key::kW}, {.alt = true}), (Controls{.forward = 1, .speed = KeyboardOptions::kSlower}));
  EXPECT_EQ(held({Key::kPageUp}), Controls{.up = 1});
  EXPECT_EQ(held({Key::kPageDown}), Controls{.up = -1});
  EXPECT_EQ(held({Key::kPageUp, Key::kE}), Controls{.up = 1}) << "two keys of one direction count once";
}

// Alt with an arrow goes through the history of views.
TEST(Keyboard, AnArrowWithAltDoesNotTurn) {
  EXPECT_EQ(held({Key::kLeft, Key::kUp}, {.alt = true}), Controls{.speed = KeyboardOptions::kSlower});
}

TEST(Keyboard, NothingMovesWhileCtrlIsHeld) {
  for (const MotionMode mode : motion_modes()) {
    for (const HeldBinding& binding : held_bindings()) {
      KeySet set;
      set.set(binding.key);
      EXPECT_EQ(keyboard_controls(set, {.ctrl = true}, mode), Controls{}) << name(binding.key);
      EXPECT_EQ(keyboard_controls(set, {.ctrl = true, .alt = true, .shift = true}, mode), Controls{});
    }
  }
}

TEST(Keyboard, SpaceClimbsInFlyAndPlaysElsewhere) {
  KeySet space;
  space.set(Key::kSpace);
  const KeyPress press{{Key::kSpace, {}}, false};
  for (const MotionMode mode : motion_modes()) {
    const bool flies = mode == MotionMode::kFly;
    EXPECT_EQ(keyboard_controls(space, {}, mode), (Controls{.up = flies ? 1.0 : 0.0}));
    EXPECT_EQ(keyboard_actions(std::span(&press, 1), mode).size(), flies ? 0U : 1U);
  }
}

TEST(MotionModes, NamesReadBackAndTheCircleGoesBothWays) {
  for (const MotionMode mode : motion_modes()) {
    EXPECT_EQ(parse_motion_mode(to_string(mode)), mode);
    EXPECT_FALSE(meaning(mode).empty());
    EXPECT_NE(next_mode(mode), MotionMode::kDrive);
    if (mode != MotionMode::kDrive) {
      EXPECT_EQ(previous_mode(next_mode(mode)), mode);
    }
  }
  EXPECT_EQ(next_mode(next_mode(next_mode(MotionMode::kOrbit))), MotionMode::kOrbit);
  EXPECT_EQ(next_mode(MotionMode::kDrive), MotionMode::kOrbit);
  for (const char* text : {"", "Orbit", "walk ", "flyy", "0"}) EXPECT_FALSE(parse_motion_mode(text)) << text;
}

TEST(Keyboard, CommonKeysHaveTheirUsualActions) {
  const std::map<std::string, Action> expected{
      {"N", {ActionKind::kNorthUp}},
      {"U", {ActionKind::kLookDown}},
      {"G", {ActionKind::kLevel}},
      {"Home", {ActionKind::kWholePlanet}},
      {"R", {ActionKind::kReset}},
      {"H", {ActionKind::kHidePanels}},
      {"F1", {ActionKind::kHelp}},
      {"F6", {ActionKind::kPanelKeys}},
      {"F11", {ActionKind::kFullScreen}},
      {"F12", {ActionKind::kScreenshot}},
      {"Backspace", {ActionKind::kViewBack}},
      {"Alt+Left", {ActionKind::kViewBack}},
      {"Alt+Right", {ActionKind::kViewForward}},
      {"1", {ActionKind::kGoToBookmark, 1}},
      {"Ctrl+9", {ActionKind::kSetBookmark, 9}},
      {"Space", {ActionKind::kPlayPause}},
      {"F", {ActionKind::kNextMode}},
      {"Shift+F", {ActionKind::kPreviousMode}},
      {"Tab", {ActionKind::kMap}},
      {"Enter", {ActionKind::kEnterOverlook}},
      {"Esc", {ActionKind::kLeave}},
      {"+", {ActionKind::kZoomIn}},
      {"Shift++", {ActionKind::kZoomIn}},
      {"-", {ActionKind::kZoomOut}},
      {"O", {ActionKind::kOrthographic}},
      {"X", {ActionKind::kCatchCursor}},
      {"Ctrl++", {ActionKind::kLettersLarger}},
      {"Ctrl+Shift++", {ActionKind::kLettersLarger}},
      {"Ctrl+-", {ActionKind::kLettersSmaller}},
      {"Ctrl+0", {ActionKind::kLettersUsual}},
  };
  for (const auto& [chord, action] : expected) EXPECT_EQ(press(chord), std::vector{action}) << chord;
  for (const char* chord : {"W", "Left", "Shift+N", "Shift+0", "F7"})
    EXPECT_TRUE(press(chord).empty()) << chord;
}

TEST(Keyboard, OnlySomeActionsRepeat) {
  EXPECT_EQ(press("+", true).size(), 1U);
  EXPECT_TRUE(press("Space", true).empty());
  EXPECT_TRUE(press("F12", true).empty());
}

TEST(Keyboard, NoKeyHasTwoActions) {
  std::set<Key> held_keys;
  for (const HeldBinding& binding : held_bindings()) {
    if (binding.mode) continue;
    EXPECT_TRUE(held_keys.insert(binding.key).second) << name(binding.key);
  }
  std::set<std::string> chords;
  std::set<ActionKind> reached;
  for (const PressedBinding& binding : pressed_bindings()) {
    EXPECT_TRUE(chords.insert(name(binding.chord)).second) << name(binding.chord);
    EXPECT_TRUE(binding.chord.with.alt || !held_keys.contains(binding.chord.key)) << name(binding.chord);
    reached.insert(binding.action.kind);
  }
  for (const ActionInfo& known : actions()) EXPECT_TRUE(reached.contains(known.kind)) << known.name;
}

TEST(Keyboard, EachRateHasBothSigns) {
  for (const HeldBinding& one : held_bindings()) {
    EXPECT_TRUE(std::any_of(held_bindings().begin(), held_bindings().end(), [&one](const HeldBinding& b) {
      return b.rate == one.rate && b.value == -one.value;
    })) << one.meaning;
  }
}

TEST(Keyboard, TheHelpNamesEveryBinding) {
  const std::string help = keyboard_help_text();
  for (const HeldBinding& binding : held_bindings()) EXPECT_NE(help.find(binding.meaning), std::string::npos);
  for (const ActionInfo& known : actions())
    EXPECT_NE(help.find(known.meaning), std::string::npos) << known.name;
  EXPECT_NE(help.find("Backspace, Alt+Left  "), std::string::npos) << help;
  EXPECT_EQ(help.find("Shift++"), std::string::npos) << help;
  EXPECT_NE(help.find("Ctrl+1 ... Ctrl+9  "), std::string::npos) << help;
}

}  // namespace
}  // namespace vpe::explore
