// Great circles on the flat map.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/explore/measure/map_view.h"

namespace vpe::explore {

// Pieces of a line, each a chain of positions.
using MapLine = std::vector<std::vector<glm::dvec2>>;

// Largest distance of a map line from the great circle.
inline constexpr double kMapLineError_px = 1.0 / 3;

// Computes the shorter great circles from place to place as positions of the map, also outside of its image.
// The error is at most kMapLineError_px, except within a pixel of the poles. A piece ends exactly at the
// meridian opposite to the map's middle, and the next one begins at the other edge. Returns no pieces for fewer
// than two places. Pure.
MapLine map_line(const MapView& map, std::span<const mars::LonLat> places);

}  // namespace vpe::explore
