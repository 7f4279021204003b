// The window of one screen: without a frame, filled by finished images.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vpe/core/image/image.h"
#include "vpe/explore/screens/placed_screen.h"

struct GLFWwindow;

namespace vpe::window {

// Owns a window with an OpenGL context of its own. The display's window must be open. For the main thread. All members
// leave the context current that was current before.
class ScreenWindow {
 public:
  // Opens the window on its monitor or at its position; it takes no focus. A screen for pairs in turn gets a context with
  // two back buffers if the driver has one. `waits_for_display`: swap() waits for the display. Throws DisplayError where
  // there is no such monitor or no window can be opened.
  ScreenWindow(const explore::ScreenSet::Entry& entry, bool waits_for_display);
  ~ScreenWindow();
  ScreenWindow(const ScreenWindow&) = delete;
  ScreenWindow& operator=(const ScreenWindow&) = delete;

  GLFWwindow* handle() const { return window_; }
  // Returns true if the window shows pairs in turn: sides -1 and 1 have images of their own.
  bool has_pairs() const { return has_pairs_; }

  // Takes the image of an eye; without pixels it is black.
  void upload(int side, const core::RgbImage& image);
  // Draws the images into the back buffers, stretched to the window. swap() shows them.
  void draw();
  void swap();
  // Returns true if the window must be drawn again because the system has lost its pixels.
  bool is_damaged() const { return is_damaged_; }
  // Hides the window if the user has closed it.
  void follow_close();
  // Returns the pixels of the image that draw() has made, for tests.
  core::RgbImage read_back();

 private:
  struct Layer {
    unsigned texture = 0;
    unsigned framebuffer = 0;
    int width = 0;  // 0: black
    int height = 0;
  };
  Layer& layer(int side) { return layers_[has_pairs_ && side > 0 ? 1 : 0]; }

  GLFWwindow* window_ = nullptr;
  bool has_pairs_ = false;
  bool is_damaged_ = false;
  std::vector<Layer> layers_;
};

}  // namespace vpe::window
