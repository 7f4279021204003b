// --box: an area by degrees.
#pragma once

#include <string>

#include "vpe/map/map_grid.h"

namespace vpe::app {

// Parses WEST,SOUTH,EAST,NORTH in degrees; empty text is all of the planet. A box whose east is not more than its west goes
// over the antimeridian. Throws UsageError.
map::PlaceBox parse_box(const std::string& text);

}  // namespace vpe::app
