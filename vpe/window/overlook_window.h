// The window of `vpe overlook`: a panorama all over it, and a bar of figures.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "vpe/explore/files/preferences.h"
#include "vpe/window/devices.h"
#include "vpe/window/display.h"
#include "vpe/window/overlook_view.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

struct OverlookWindowSetup {
  OverlookSetup view;
  DisplayOptions display;
  explore::Preferences preferences;  // budget and wheel of the view, and devices, are as they say
  DeviceSources devices;
};

class OverlookWindow {
 public:
  // Throws DisplayError, and as OverlookView.
  explicit OverlookWindow(OverlookWindowSetup setup);

  // One turn: events, devices, an image when one is due, a frame when something changed. Waits for events for
  // at most so long when there is nothing to do. False when the window is closed.
  bool step(double wait_s);

  OverlookView& view() { return view_; }
  Display& display() { return display_; }
  const Devices& devices() const { return devices_; }
  const Widgets& widgets() const { return widgets_; }
  // Nothing moves, loads or waits to be drawn.
  bool is_at_rest() const { return view_.is_at_rest() && frames_due_ <= 0; }
  std::int64_t frames() const { return frames_; }
  // The next frame's pixels, once it is shown.
  void capture(core::RgbImage* to) { capture_ = to; }

 private:
  void act(const explore::Action& action);
  void lay_out();
  void draw_frame();
  void draw_bar();
  void draw_figures();
  void draw_buttons();
  void draw_help();
  double now_s() const;

  explore::Preferences preferences_;
  Display display_;
  Devices devices_;
  Widgets widgets_;
  OverlookView view_;
  std::string trouble_;          // with a device
  std::optional<Event> cursor_;  // where it was moved last
  bool was_captured_ = false;    // by a panel
  bool bar_ = true;
  bool help_ = false;
  double bar_height_ = 0;
  int width_ = 1;
  int height_ = 1;
  std::chrono::steady_clock::time_point begun_;
  std::chrono::steady_clock::time_point last_turn_;
  int frames_due_;
  std::int64_t frames_ = 0;
  core::RgbImage* capture_ = nullptr;
};

}  // namespace vpe::window
