// Cuts shapes where longitudes of maps begin and end.
#pragma once

#include <vector>

#include "mars/vector/feature.h"

namespace mars {

// Returns the parts of a shape whose longitudes are in [-180, 180], in degrees: lines and polygons are cut at the
// antimeridian, as RFC 7946, section 3.1.9, asks for. Edges are straight in degrees. A ring around a pole is closed along
// the antimeridian and the pole's parallel, so that the part covers the pole in plane maps. Outlines run counterclockwise,
// holes clockwise. What is inside by the even-odd rule stays inside; the outlines of a valid polygon stay valid. Parts
// without length or area are left out, unless the shape has no other. Longitudes must be unwrapped, see
// unwrap_longitudes(). Pure.
std::vector<Shape> cut_at_antimeridian(const Shape& shape);

}  // namespace mars
