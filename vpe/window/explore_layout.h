// Places of the parts of the explore window: view, side panel, status line.
#pragma once

#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

struct LayoutLimits {
  static constexpr double kSide_px = 330;  // width of the side panel at scale 1
  static constexpr double kNarrowest_px = 250;
  static constexpr double kWidest_px = 640;
  static constexpr double kNarrowWindow_px = 800;  // below, the side panel lies over the view when it is open
  static constexpr double kLeastView_px = 160;     // of the view's width beside the panel
  static constexpr double kStatus_px = 27;         // height of the status line
  static constexpr double kLeastHeight_px = 230;   // of a window, for search, map, tabs and a part of a panel
  static constexpr double kSideShare = 0.9;  // of a narrow window's width that the side panel takes at most
};

struct LayoutInput {
  int width = 1280;  // of the framebuffer, pixels
  int height = 720;
  double scale = 1;
  bool panels = true;         // side panel and status line are shown
  double side_px = 0;         // width that the user chose, at scale 1; 0: none chosen
  bool side_is_open = false;  // in a narrow window
};

// Describes parts in framebuffer pixels. A part that is not shown has no width.
struct ExploreLayout {
  ViewArea view;
  ViewArea side{0, 0, 0, 0};
  ViewArea status{0, 0, 0, 0};
  bool is_narrow = false;  // the side panel lies over the view
};

// Returns the largest scale at which the side panel is as wide as its content in a window of this size, and as high as
// what it shows above a panel. Is a multiple of 0.05. Pure.
double largest_scale(int width, int height);

// Computes the layout. The view covers all that the side panel and the status line leave. Pure.
ExploreLayout layout_of(const LayoutInput& input);

}  // namespace vpe::window
