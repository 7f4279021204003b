// Where a view stands in its window.
#pragma once

namespace vpe::window {

// A part of the window, framebuffer pixels.
struct ViewArea {
  double x = 0;
  double y = 0;
  double width = 16;
  double height = 16;
  bool holds(double px, double py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

}  // namespace vpe::window
