// Great circles on the flat map.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/explore/measure/map_view.h"

namespace vpe::explore {

// Pieces of a line, each drawn from its first position to its last.
using MapLine = std::vector<std::vector<glm::dvec2>>;

// The shorter great circle from place to place, in positions of the map (also outside of its image), no
// farther from it than a third of a pixel, except within a pixel of the poles. A piece ends at the meridian
// opposite to the map's middle, exactly there, and the next one begins at the other edge. Nothing for fewer
// than two places. Pure.
inline constexpr double kMapLineError_px = 1.0 / 3;
MapLine map_line(const MapView& map, std::span<const mars::LonLat> places);

}  // namespace vpe::explore
