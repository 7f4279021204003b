// The palettes that are always there; for palette.cpp.
#pragma once

#include <string_view>

#include "vpe/core/appearance/palette.h"

namespace vpe::core {

// Null for a name that is not one of palette_names().
const Palette* built_in_palette(std::string_view name);

// HSV, straight in hue, saturation and value, from 0 to 1: stops at the corners of its curve and 256 times in
// between, which keeps the error below 0.1 of 255.
Palette hsv_palette(const HsvRamp& ramp);

}  // namespace vpe::core
