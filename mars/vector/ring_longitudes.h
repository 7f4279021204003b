// Longitudes of neighbouring vertices, and rings around poles.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "mars/vector/feature.h"

namespace mars {

// Adds multiples of 360 degrees to longitudes, so that neighbouring ones differ by at most 180 degrees: files count them
// from -180 to 180 or from 0 to 360, and jump where these end. A longitude that needs no change keeps its bits. The
// first vertex comes into [-180, 180]; holes come beside their outline.
//
// A ring that goes around a pole then ends a multiple of 360 degrees beside its first vertex, see pole_of().
//
// Rings of polygons are closed where they are not: the last vertex repeats the first one to the bit, but for full turns.
//
// An edge of exactly 360 degrees, as maps of the whole planet have, leads nowhere on a sphere. Where a ring would else
// enclose nothing or not close, or a line would have no length, such edges are taken as a full turn in the direction
// that is written, and two vertices are put in. Longitudes must be finite.
void unwrap_longitudes(Shape& shape);

// Names a pole.
enum class RingPole { none, north, south };

// Returns the pole that a closed ring with unwrapped longitudes goes around: its last longitude is an odd multiple of
// 360 degrees beside its first one. Of both poles it is the one on whose side its mean latitude lies, weighted by
// longitude: the part of the planet that has fewer square degrees.
RingPole pole_of(const std::vector<glm::dvec2>& ring);

}  // namespace mars
