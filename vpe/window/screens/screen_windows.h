// The windows of all screens of a set: their images for the newest place of the head, shown together.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/explore/images/live_image.h"
#include "vpe/explore/input/head_tracker.h"
#include "vpe/explore/screens/screen_view.h"
#include "vpe/window/screens/screen_maker.h"
#include "vpe/window/screens/screen_window.h"

namespace vpe::window {

// Describes what screens show.
struct ScreenScene {
  ImageRequest base;          // everything but the view
  std::string state;          // of all that images depend on besides platform and head
  mars::CameraPose platform;  // the camera of a head at rest
  explore::HeadPlace head;
  double nearest_m = 1;  // distance of the nearest ground
  double budget_ms = 0;  // of a round while something moves; 0: none
};

// Opens and fills the windows. The display's window must be open as long. For the main thread.
//
// Typical usage, in each iteration of the event loop:
//   windows.update(scene);
//   wait for events as long as windows.is_at_rest() allows
class ScreenWindows {
 public:
  // Throws DisplayError. Calls `notify` on another thread when a round of images is finished.
  ScreenWindows(explore::ScreenSet set, const MakePainter& make_painter, std::function<void()> notify);

  // Draws with another painter from now on.
  void set_painter(const MakePainter& make_painter);

  // Shows the images of a finished round, and asks for the next one if the scene differs from it or its images were not
  // the final ones. Returns true if new images are shown. Keeps of `scene` what it needs.
  bool update(const ScreenScene& scene);

  // Returns true if no round is being drawn and none is due for the last scene.
  bool is_at_rest() const;
  // Returns why the last round has no images, or "".
  const std::string& error() const { return error_; }
  // Returns what users should know about the windows that were opened.
  const std::vector<std::string>& notes() const { return notes_; }
  const explore::ScreenSet& set() const { return set_; }
  // Returns the window of a screen.
  ScreenWindow& window(std::size_t n) { return *windows_[n]; }
  // Returns the number of rounds that were shown.
  std::int64_t rounds() const { return rounds_; }

 private:
  std::vector<ScreenOrder> orders(const ScreenScene& scene) const;
  bool show();

  explore::ScreenSet set_;
  std::function<void()> notify_;
  std::vector<std::unique_ptr<ScreenWindow>> windows_;
  std::vector<std::string> notes_;
  explore::LiveImage live_;
  std::string asked_state_;
  std::vector<ScreenOrder> asked_;
  std::string error_;
  std::int64_t rounds_ = 0;
  std::unique_ptr<ScreenMaker> maker_;
};

}  // namespace vpe::window
