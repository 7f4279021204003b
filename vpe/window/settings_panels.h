// The panels "Appearance" and "Detail", which contain all keys of the settings registry.
#pragma once

#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/explore/session.h"
#include "vpe/window/painter.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

// Draw a panel inside its tab and apply changes to the session. Return what is wrong with a changed setting, or
// "". `drawn` is the image shown last, or null; its tiles are listed by level, and the ends of its palette are
// shown where the settings take them from the view.
std::string draw_appearance_panel(explore::Session& session, const DrawnImage* drawn, Widgets& widgets);
std::string draw_detail_panel(explore::Session& session, const DrawnImage* drawn,
                              const paging::PlanetFile& planet, Widgets& widgets);

}  // namespace vpe::window
