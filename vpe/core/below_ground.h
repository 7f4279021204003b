// The frame of a camera below the ground.
#pragma once

#include "vpe/core/frame.h"

namespace vpe::core {

// Fills the frame of a camera below the reference surface: one colour, range 0, and a certificate that claims
// nothing (infinite bounds). Both backends draw it. Pure.
void draw_below_ground(const DrawRequest& request, DrawResult& result);

}  // namespace vpe::core
