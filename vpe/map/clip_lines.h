// Cuts lines at the edges of a box of longitudes and latitudes.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/map/map_grid.h"

namespace vpe::map {

// Returns the parts of a line inside a box, in their order. Vertices are degrees east and north, with
// longitudes of neighbours that differ by at most 180 degrees; edges are straight in degrees. A line whose last
// vertex repeats the first one, also a turn of 360 degrees on, is a ring: a part that goes over its seam is
// one. Longitudes of parts begin within 180 degrees of the box's middle. Pure.
std::vector<std::vector<glm::dvec2>> clip_line(std::span<const glm::dvec2> line, const PlaceBox& box);

}  // namespace vpe::map
