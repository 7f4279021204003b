// Pixels as a virtual screen shows them.
#pragma once

#include "vpe/core/image/image.h"

namespace vpe::window {

// Returns a rectangle of the screen that `DISPLAY` names. Throws std::runtime_error if there is none.
core::RgbImage screen_pixels(int x, int y, int width, int height);

}  // namespace vpe::window
