// A row of switches over the view for what is drawn over images: names, scale, north and the like.
#pragma once

#include <string>
#include <vector>

#include "vpe/explore/session.h"
#include "vpe/window/ui/imgui_helpers.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Draws the row over the upper right of a view and applies changes to the session. `names` is the file of places
// that the switch "Names" shows; empty: the switch is not there. Returns what is wrong with a change, or "".
std::string draw_overlay_bar(const ViewArea& area, double scale, explore::Session& session,
                             const std::string& names, Widgets& widgets);

// Returns the width that the row needs at the right edge of a view. Pure.
double overlay_bar_width_px(const std::string& names, double scale);

// Returns the assignments of the session's overlays that are on, as "overlay.scale=on", to be kept. Pure.
std::vector<std::string> overlays_on(const core::Settings& settings);

}  // namespace vpe::window
