// The panel "Detail": level of detail, rays, sampling, and the tiles of the image.
#pragma once

#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/explore/session.h"
#include "vpe/window/ui/widgets.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Draws the panel inside its tab and applies changes to the session. Returns what is wrong with a changed setting,
// or "". `drawn` is the image shown last, or null; its tiles are listed by level.
std::string draw_detail_panel(explore::Session& session, const DrawnImage* drawn,
                              const paging::PlanetFile& planet, Widgets& widgets);

}  // namespace vpe::window
