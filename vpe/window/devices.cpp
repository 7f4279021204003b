#include "vpe/window/devices.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <utility>

namespace vpe::window {

namespace {

using explore::Key;

std::optional<Key> key_of(int code) {
  const auto from = [code](int first, Key key) {
    return static_cast<Key>(static_cast<int>(key) + (code - first));
  };
  if (code >= GLFW_KEY_A && code <= GLFW_KEY_Z) return from(GLFW_KEY_A, Key::kA);
  if (code >= GLFW_KEY_0 && code <= GLFW_KEY_9) return from(GLFW_KEY_0, Key::k0);
  if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F12) return from(GLFW_KEY_F1, Key::kF1);
  if (code >= GLFW_KEY_KP_0 && code <= GLFW_KEY_KP_9) return from(GLFW_KEY_KP_0, Key::k0);
  static constexpr std::pair<int, Key> kOthers[] = {
      {GLFW_KEY_LEFT, Key::kLeft},
      {GLFW_KEY_RIGHT, Key::kRight},
      {GLFW_KEY_UP, Key::kUp},
      {GLFW_KEY_DOWN, Key::kDown},
      {GLFW_KEY_SPACE, Key::kSpace},
      {GLFW_KEY_TAB, Key::kTab},
      {GLFW_KEY_ENTER, Key::kEnter},
      {GLFW_KEY_KP_ENTER, Key::kEnter},
      {GLFW_KEY_ESCAPE, Key::kEscape},
      {GLFW_KEY_BACKSPACE, Key::kBackspace},
      {GLFW_KEY_INSERT, Key::kInsert},
      {GLFW_KEY_DELETE, Key::kDelete},
      {GLFW_KEY_HOME, Key::kHome},
      {GLFW_KEY_END, Key::kEnd},
      {GLFW_KEY_PAGE_UP, Key::kPageUp},
      {GLFW_KEY_PAGE_DOWN, Key::kPageDown},
      {GLFW_KEY_EQUAL, Key::kPlus},
      {GLFW_KEY_KP_ADD, Key::kPlus},
      {GLFW_KEY_MINUS, Key::kMinus},
      {GLFW_KEY_KP_SUBTRACT, Key::kMinus},
      {GLFW_KEY_COMMA, Key::kComma},
      {GLFW_KEY_PERIOD, Key::kPeriod},
      {GLFW_KEY_SLASH, Key::kSlash},
      {GLFW_KEY_SEMICOLON, Key::kSemicolon},
      {GLFW_KEY_APOSTROPHE, Key::kApostrophe},
      {GLFW_KEY_LEFT_BRACKET, Key::kLeftBracket},
      {GLFW_KEY_RIGHT_BRACKET, Key::kRightBracket},
      {GLFW_KEY_BACKSLASH, Key::kBackslash},
      {GLFW_KEY_GRAVE_ACCENT, Key::kGrave},
  };
  for (const auto& [number, key] : kOthers)
    if (number == code) return key;
  return std::nullopt;
}

// Returns the number and the state of the first gamepad.
std::optional<std::pair<int, GLFWgamepadstate>> find_pad() {
  for (int n = GLFW_JOYSTICK_1; n <= GLFW_JOYSTICK_LAST; ++n) {
    GLFWgamepadstate state;
    if (glfwJoystickIsGamepad(n) == GLFW_TRUE && glfwGetGamepadState(n, &state) == GLFW_TRUE)
      return std::pair{n, state};
  }
  return std::nullopt;
}

std::optional<explore::PadState> first_pad() {
  const auto found = find_pad();
  if (!found) return std::nullopt;
  const GLFWgamepadstate& state = found->second;
  explore::PadState pad;
  std::copy(std::begin(state.buttons), std::end(state.buttons), pad.buttons.begin());
  std::copy(std::begin(state.axes), std::end(state.axes), pad.axes.begin());
  return pad;
}

std::string name_of_first_pad() {
  const auto found = find_pad();
  const char* name = found ? glfwGetGamepadName(found->first) : nullptr;
  return name == nullptr ? "a gamepad" : name;
}

}  // namespace

Devices::Devices(const explore::Preferences& preferences, DeviceSources sources)
    : preferences_(preferences), sources_(std::move(sources)), tracker_(preferences.head) {
  if (!sources_.pad) sources_.pad = first_pad;
  if (!sources_.pad_name) sources_.pad_name = name_of_first_pad;
  open_devices();
}

std::vector<std::string> Devices::use(const explore::Preferences& preferences, double time_s) {
  const bool listens_elsewhere = !(preferences.head_from == preferences_.head_from);
  preferences_ = preferences;
  tracker_.set_options(preferences.head, time_s);
  if (!preferences.use_head_tracker || listens_elsewhere) receiver_.reset();
  errors_.clear();
  open_devices();
  return errors_;
}

void Devices::open_devices() {
  if (preferences_.use_space_mouse && sources_.space_mouse == nullptr) {
    try {
      sources_.space_mouse = explore::open_space_mouse();
    } catch (const explore::DeviceError&) {
      // Few users have a space mouse, so its absence is not reported.
    }
  }
  if (preferences_.use_head_tracker && receiver_ == nullptr) {
    try {
      receiver_ = std::make_unique<explore::UdpReceiver>(preferences_.head_from);
    } catch (const explore::DeviceError& e) {
      errors_.emplace_back(e.what());
    }
  }
}

DeviceStates Devices::states(double time_s) const {
  DeviceStates states;
  if (pad_) states.pad = ShownPad{sources_.pad_name(), pad_->buttons, pad_->axes, pad_controls_};
  if (sources_.space_mouse != nullptr) states.space_mouse = cap_controls_;
  if (receiver_ != nullptr)
    states.tracker = ShownTracker{receiver_->port(), tracker_.is_live(time_s), tracker_.look(time_s),
                                  tracker_.received(), tracker_.ignored()};
  states.errors = errors_;
  return states;
}

std::optional<int> Devices::tracker_port() const {
  return receiver_ ? std::optional(receiver_->port()) : std::nullopt;
}

void Devices::key(const Event& event) {
  with_ = {(event.modifiers & GLFW_MOD_CONTROL) != 0, (event.modifiers & GLFW_MOD_ALT) != 0,
           (event.modifiers & GLFW_MOD_SHIFT) != 0};
  // GLFW's modifiers in the event of a modifier key do not include that key.
  const bool is_down = event.kind != Event::Kind::kKeyRelease;
  if (event.code == GLFW_KEY_LEFT_SHIFT || event.code == GLFW_KEY_RIGHT_SHIFT) with_.shift = is_down;
  if (event.code == GLFW_KEY_LEFT_CONTROL || event.code == GLFW_KEY_RIGHT_CONTROL) with_.ctrl = is_down;
  if (event.code == GLFW_KEY_LEFT_ALT || event.code == GLFW_KEY_RIGHT_ALT) with_.alt = is_down;
  const std::optional<Key> key = key_of(event.code);
  if (!key) return;
  held_.set(*key, is_down);
  if (is_down) presses_.push_back({{*key, with_}, event.kind == Event::Kind::kKeyRepeat});
}

bool Devices::polls(double time_s) const {
  return pad_ || explore::any(cap_controls_) || receiver_ != nullptr || tracker_.is_moving(time_s);
}

DeviceReading Devices::read(double time_s, bool typing, explore::MotionMode mode) {
  DeviceReading reading;
  std::vector<explore::Controls> controls;
  const auto add = [&reading](const std::vector<explore::Action>& actions) {
    reading.actions.insert(reading.actions.end(), actions.begin(), actions.end());
  };
  const std::vector<explore::KeyPress> presses = std::exchange(presses_, {});
  if (!typing) {
    controls.push_back(explore::keyboard_controls(held_, with_, mode));
    add(explore::keyboard_actions(presses, mode));
  }
  pad_ = preferences_.use_gamepad ? sources_.pad() : std::nullopt;
  const explore::PadReading pad = gamepad_.read(pad_, preferences_.gamepad);
  pad_controls_ = pad.controls;
  controls.push_back(pad.controls);
  add(pad.actions);
  cap_controls_ = {};
  if (sources_.space_mouse != nullptr) {
    // What is switched off is read too, or its events would come late.
    const explore::SpaceMouseReading cap =
        space_mouse_.read(sources_.space_mouse->poll(), preferences_.space_mouse, time_s);
    if (preferences_.use_space_mouse) {
      cap_controls_ = cap.controls;
      controls.push_back(cap.controls);
      add(cap.actions);
    }
  }
  reading.controls = explore::combine(controls);
  for (double explore::Controls::*rate :
       {&explore::Controls::yaw_right, &explore::Controls::pitch_up, &explore::Controls::roll_right})
    reading.controls.*rate *= preferences_.turn_speed;
  reading.controls.speed *= preferences_.fly_speed;
  if (receiver_ != nullptr)
    receiver_->poll([&](std::span<const std::uint8_t> bytes) { tracker_.receive(bytes, time_s); });
  reading.head = tracker_.place(time_s);
  reading.look = reading.head.look;
  return reading;
}

}  // namespace vpe::window
