// The window of `vpe overlook`: a panorama and a bar with its values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "vpe/explore/files/preferences.h"
#include "vpe/window/devices.h"
#include "vpe/window/overlook_view.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

struct OverlookWindowSetup {
  OverlookSetup view;
  DisplayOptions display;
  explore::Preferences preferences;  // override budget and wheel of the view; configure the devices
  DeviceSources devices;
};

// Shows one panorama. For the main thread.
//
// Typical usage:
//   OverlookWindow window(std::move(setup));
//   while (window.step(0.5)) {
//   }
class OverlookWindow {
 public:
  // Throws DisplayError, and what OverlookView throws.
  explicit OverlookWindow(OverlookWindowSetup setup);

  // Runs one iteration of the event loop: events, devices, an image if one is due, a frame if something
  // changed. Waits for events for at most `wait_s` seconds if there is nothing to do. Returns false if the
  // window was closed.
  bool step(double wait_s);

  OverlookView& view() { return view_; }
  Display& display() { return display_; }
  const Devices& devices() const { return devices_; }
  const Widgets& widgets() const { return widgets_; }
  // Returns true if nothing moves, is being drawn, or waits to be shown.
  bool is_at_rest() const { return view_.is_at_rest() && frames_due_ <= 0; }
  std::int64_t frames() const { return frames_; }
  // Stores the pixels of the next frame that is shown.
  void capture(core::RgbImage* to) { capture_ = to; }

 private:
  void act(const explore::Action& action);
  void lay_out();
  void draw_frame();
  void draw_bar();
  void draw_values();
  void draw_buttons();
  void draw_help();
  double now_s() const;

  explore::Preferences preferences_;
  Display display_;
  Devices devices_;
  Widgets widgets_;
  OverlookView view_;
  std::string device_error_;
  std::optional<Event> cursor_;  // its last motion
  bool was_captured_ = false;    // by a panel
  bool bar_ = true;
  bool help_ = false;
  double bar_height_ = 0;
  int width_ = 1;
  int height_ = 1;
  double begun_s_;  // of the display's clock
  double last_step_s_;
  int frames_due_;
  std::optional<double> tip_at_s_;  // when a tooltip is due
  std::int64_t frames_ = 0;
  core::RgbImage* capture_ = nullptr;
};

}  // namespace vpe::window
