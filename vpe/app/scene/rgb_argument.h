// Colours on the command line.
#pragma once

#include <optional>
#include <string>

#include "vpe/base/rgb.h"

namespace vpe::app {

// Returns the colour of "#rrggbb" or "rrggbb", which shells take as it is; nullopt for anything else. Pure.
std::optional<base::Rgb> parse_rgb(std::string text);

}  // namespace vpe::app
