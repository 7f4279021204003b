// Marks of reliefs in the view.
#pragma once

#include <imgui.h>

#include "relief/spec.h"
#include "vpe/window/marks/ground_view.h"

namespace vpe::window {

// Draws a cross at the middle of a relief, on the ground as drawn; faint where the ground hides it. A chosen one also has
// its outline and name.
void draw_relief_mark(ImDrawList& list, const GroundView& ground, const EyeImage& eye,
                      const relief::ReliefSpec& relief, bool is_chosen);

}  // namespace vpe::window
