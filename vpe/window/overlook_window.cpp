#include "vpe/window/overlook_window.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vpe::window {

namespace {

using explore::ActionKind;

constexpr double kShortestFrame_s = 1.0 / 120;
constexpr double kPoll_s = 1.0 / 60;   // of devices that send no events
constexpr double kImageWait_s = 0.1;   // limit of waiting for an image in one iteration
constexpr int kFramesAfterChange = 3;  // ImGui settles within these

OverlookSetup preferred(OverlookSetup setup, const explore::Preferences& preferences) {
  setup.budget_ms = preferences.draw_budget_ms;
  setup.invert_wheel = preferences.invert_wheel;
  return setup;
}

DisplayOptions preferred(DisplayOptions options, const explore::Preferences& preferences) {
  if (options.scale <= 0) options.scale = preferences.ui_scale;
  return options;
}

}  // namespace

OverlookWindow::OverlookWindow(OverlookWindowSetup setup)
    : preferences_(std::move(setup.preferences)),
      display_(preferred(setup.display, preferences_)),
      devices_(preferences_, std::move(setup.devices)),
      view_(preferred(std::move(setup.view), preferences_)),
      begun_s_(display_.now_s()),
      last_step_s_(begun_s_),
      frames_due_(kFramesAfterChange) {
  for (const std::string& error : devices_.errors()) device_error_ = error;
  lay_out();
}

double OverlookWindow::now_s() const { return display_.now_s() - begun_s_; }

bool OverlookWindow::step(double wait_s) {
  const bool busy = !is_at_rest();
  double longest_s = devices_.polls(now_s()) ? std::min(wait_s, kPoll_s) : wait_s;
  if (tip_at_s_) longest_s = std::min(longest_s, std::max(*tip_at_s_ - now_s(), 0.001));
  const double pause_s = std::max(0.0, kShortestFrame_s - (display_.now_s() - last_step_s_));
  const std::vector<Event> events = display_.events(busy ? pause_s : longest_s);
  if (display_.should_close()) return false;
  if (tip_at_s_ && now_s() >= *tip_at_s_) {
    tip_at_s_.reset();
    frames_due_ = std::max(frames_due_, 1);
  }
  lay_out();
  const bool captured = ImGui::GetIO().WantCaptureMouse;
  for (const Event& event : events) {
    if (event.kind == Event::Kind::kKeyPress || event.kind == Event::Kind::kKeyRepeat ||
        event.kind == Event::Kind::kKeyRelease)
      devices_.key(event);
    else
      view_.handle(event, captured);
    if (event.kind == Event::Kind::kMove) cursor_ = event;
    frames_due_ = kFramesAfterChange;
  }
  // ImGui updates WantCaptureMouse with the next frame, when the cursor may rest already.
  if (cursor_ && captured != was_captured_) view_.handle(*cursor_, captured);
  was_captured_ = captured;
  const double step_s = display_.now_s();
  // The time of a rest does not count as motion.
  const double dt_s = busy ? step_s - last_step_s_ : 0.0;
  last_step_s_ = step_s;
  const DeviceReading reading = devices_.read(now_s(), ImGui::GetIO().WantTextInput);
  for (const explore::Action& action : reading.actions) act(action);
  view_.advance(reading.controls, reading.look, dt_s, reading.head.position_m);
  lay_out();
  if (view_.update(kImageWait_s)) frames_due_ = std::max(frames_due_, 1);
  if (frames_due_ > 0) {
    draw_frame();
    --frames_due_;
    tip_at_s_ = widgets_.tip_due_s() ? std::optional(now_s() + *widgets_.tip_due_s()) : std::nullopt;
  }
  return !display_.should_close();
}

void OverlookWindow::act(const explore::Action& action) {
  frames_due_ = kFramesAfterChange;
  device_error_.clear();
  switch (action.kind) {
    case ActionKind::kHidePanels: bar_ = !bar_; break;
    case ActionKind::kHelp: help_ = !help_; break;
    case ActionKind::kFullScreen: display_.set_fullscreen(!display_.is_fullscreen()); break;
    case ActionKind::kRecentreHead: devices_.recentre(now_s()); break;
    case ActionKind::kLeave:
      if (help_)
        help_ = false;
      else
        display_.close();
      break;
    default: view_.act(action); break;
  }
}

void OverlookWindow::lay_out() {
  const std::pair before{width_, height_};
  display_.framebuffer(width_, height_);
  if (before != std::pair{width_, height_}) frames_due_ = kFramesAfterChange;
  bar_height_ = bar_ ? std::round(52 * display_.scale()) : 0.0;
  view_.place({0, 0, std::max(16.0, static_cast<double>(width_)), std::max(16.0, height_ - bar_height_)});
}

void OverlookWindow::draw_frame() {
  display_.begin_frame();
  widgets_.begin_frame();
  view_.draw();
  if (bar_) draw_bar();
  if (help_) draw_help();
  display_.end_frame(std::exchange(capture_, nullptr));
  ++frames_;
}

}  // namespace vpe::window
