#include "tests/window/screen_pixels.h"

// After the project's: X names many things.
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <stdexcept>

namespace vpe::window {

core::RgbImage screen_pixels(int x, int y, int width, int height) {
  ::Display* display = XOpenDisplay(nullptr);
  if (display == nullptr) throw std::runtime_error("no X server to take pixels from");
  XImage* taken = XGetImage(display, DefaultRootWindow(display), x, y, static_cast<unsigned>(width),
                            static_cast<unsigned>(height), AllPlanes, ZPixmap);
  core::RgbImage image{width, height, {}};
  for (int row = 0; taken != nullptr && row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const unsigned long pixel = XGetPixel(taken, column, row);
      image.pixels.push_back({static_cast<std::uint8_t>(pixel >> 16U), static_cast<std::uint8_t>(pixel >> 8U),
                              static_cast<std::uint8_t>(pixel)});
    }
  if (taken != nullptr) XDestroyImage(taken);
  XCloseDisplay(display);
  if (image.pixels.empty()) throw std::runtime_error("the X server does not tell its pixels");
  return image;
}

}  // namespace vpe::window
