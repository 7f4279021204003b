// The built-in palettes.
#pragma once

#include <string_view>

#include "vpe/core/appearance/palette.h"

namespace vpe::core {

// Returns a built-in palette, or null for a name that is not one of palette_names().
const Palette* built_in_palette(std::string_view name);

// Returns the palette from 0 to 1 that is linear in hue, saturation and value. It has stops at the corners of
// the HSV curve and 256 between them, which keeps the error below 0.1 of 255.
Palette hsv_palette(const HsvRamp& ramp);

}  // namespace vpe::core
