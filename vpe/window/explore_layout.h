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

// Computes the layout. The view covers all that the side panel and the status line leave. Pure.
ExploreLayout layout_of(const LayoutInput& input);

}  // namespace vpe::window
