#include "vpe/explore/input/gamepad.h"

#include <algorithm>
#include <cmath>

namespace vpe::explore {

namespace {

using A = ActionKind;

constexpr std::array kBindings{
    PadBinding{PadButton::kA, {A::kEnterOverlook}}, PadBinding{PadButton::kB, {A::kLeave}},
    PadBinding{PadButton::kX, {A::kNorthUp}},       PadBinding{PadButton::kY, {A::kLevel}},
    PadBinding{PadButton::kBack, {A::kMap}},        PadBinding{PadButton::kStart, {A::kPlayPause}},
    PadBinding{PadButton::kUp, {A::kZoomIn}},       PadBinding{PadButton::kDown, {A::kZoomOut}},
    PadBinding{PadButton::kLeft, {A::kViewBack}},   PadBinding{PadButton::kRight, {A::kViewForward}},
};

double finite(float value, double otherwise) {
  return std::isfinite(value) ? static_cast<double>(value) : otherwise;
}

double trigger(float value, const PadOptions& options) {
  return stick_rate((finite(value, -1.0) + 1.0) / 2.0, options.trigger_dead_zone, options.curve);
}

double difference(const PadState& state, PadButton more, PadButton less) {
  return (state.is_down(more) ? 1.0 : 0.0) - (state.is_down(less) ? 1.0 : 0.0);
}

}  // namespace

Controls pad_controls(const PadState& state, const PadOptions& options) {
  const auto stick = [&](PadAxis x, PadAxis y) {
    return stick_rates({finite(state.axis(x), 0.0), finite(state.axis(y), 0.0)}, options.dead_zone,
                       options.curve);
  };
  const glm::dvec2 left = stick(PadAxis::kLeftX, PadAxis::kLeftY);
  const glm::dvec2 right = stick(PadAxis::kRightX, PadAxis::kRightY);
  Controls controls;
  controls.right = left.x;
  controls.forward = -left.y;
  controls.yaw_right = right.x;
  controls.pitch_up = options.invert_pitch ? right.y : -right.y;
  controls.up = trigger(state.axis(PadAxis::kRightTrigger), options) -
                trigger(state.axis(PadAxis::kLeftTrigger), options);
  controls.roll_right = difference(state, PadButton::kRightBumper, PadButton::kLeftBumper);
  if (state.is_down(PadButton::kLeftStick)) controls.speed *= PadOptions::kFaster;
  if (state.is_down(PadButton::kRightStick)) controls.speed *= PadOptions::kSlower;
  return controls;
}

std::span<const PadBinding> pad_bindings() { return kBindings; }

PadReading Gamepad::read(const std::optional<PadState>& state, const PadOptions& options) {
  PadReading reading;
  if (!state) {
    before_.reset();
    has_reported_ = {};
    return reading;
  }
  PadState now = *state;
  for (std::size_t n = 0; n < has_reported_.size(); ++n) {
    float& value = now.axes[static_cast<std::size_t>(PadAxis::kLeftTrigger) + n];
    has_reported_[n] = has_reported_[n] || value != 0.0F;
    if (!has_reported_[n]) value = -1.0F;
  }
  reading.controls = pad_controls(now, options);
  for (const PadBinding& binding : kBindings) {
    if (before_ && now.is_down(binding.button) && !before_->is_down(binding.button)) {
      reading.actions.push_back(binding.action);
    }
  }
  before_ = now;
  return reading;
}

}  // namespace vpe::explore
