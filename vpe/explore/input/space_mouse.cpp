#include "vpe/explore/input/space_mouse.h"

#include <algorithm>

namespace vpe::explore {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::optional<Action> action_of(int button) {
  if (button == 0) return Action{ActionKind::kLevel};
  if (button == 1) return Action{ActionKind::kReset};
  return std::nullopt;
}

}  // namespace

Controls space_mouse_controls(const SpaceMouseMotion& motion, const SpaceMouseOptions& options) {
  const auto rate = [&options](int value) {
    const double deflection = static_cast<double>(value) / SpaceMouseOptions::kFull;
    return (options.holds_ground ? -1.0 : 1.0) * axis_rate(deflection, options.dead_zone, options.curve);
  };
  Controls controls;
  controls.right = rate(motion.move[0]);
  controls.up = rate(motion.move[1]);
  controls.forward = rate(motion.move[2]);
  controls.pitch_up = rate(motion.rotate[0]);
  controls.yaw_right = -rate(motion.rotate[1]);
  if (options.roll) controls.roll_right = rate(motion.rotate[2]);
  return controls;
}

SpaceMouseReading SpaceMouse::read(std::span<const SpaceMouseEvent> events, const SpaceMouseOptions& options,
                                   double time_s) {
  SpaceMouseReading reading;
  for (const SpaceMouseEvent& event : events) {
    std::visit(Overloaded{[&](const SpaceMouseMotion& motion) {
                            motion_ = motion;
                            moved_s_ = time_s;
                          },
                          [&](const SpaceMouseButton& button) {
                            const auto at = std::find(down_.begin(), down_.end(), button.number);
                            if (button.is_down == (at != down_.end())) return;
                            if (!button.is_down) {
                              down_.erase(at);
                              return;
                            }
                            down_.push_back(button.number);
                            if (const auto action = action_of(button.number))
                              reading.actions.push_back(*action);
                          },
                          [&](const SpaceMouseGone&) {
                            motion_ = {};
                            down_.clear();
                          }},
               event);
  }
  if (time_s - moved_s_ > kTimeout_s) motion_ = {};
  reading.controls = space_mouse_controls(motion_, options);
  return reading;
}

}  // namespace vpe::explore
