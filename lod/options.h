// From what is asked of an image to what select() is asked: in one place, so that who explains an image and
// who draws it cannot differ. Pure.
#pragma once

#include "lod/select.h"
#include "vpe/core/frame.h"

namespace lod {

LevelControl level_control(const vpe::core::DrawRequest& request, double planet_radius_m);

// most_triangles: what the drawer can hold, > 0; the request's own cap counts when it is less.
SelectOptions select_options(const vpe::core::DrawRequest& request, double planet_radius_m,
                             std::int64_t most_triangles);

}  // namespace lod
