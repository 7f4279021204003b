// The help of the explore window: what mouse and keys do.
#pragma once

#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Draws the help in the middle of a part of the window, no larger than that: keys in two columns where there is room,
// else in one, to be scrolled. `is_open` becomes false when it is closed.
void draw_explore_help(const ViewArea& area, bool& is_open, Widgets& widgets);

}  // namespace vpe::window
