// Simplification of contours that keeps them apart.
#pragma once

#include <vector>

#include "vpe/map/contour/contour.h"

namespace vpe::map {

// Leaves out points of lines. Points that stay are unchanged, and ends of open lines stay. Any thread may call
// it; the result does not depend on `threads` (0: all cores).
//
// - Each line and its simplified one lie within `tolerance_posts` of each other (Hausdorff distance), up to
//   rounding.
// - If the given lines do not cross, no simplified line crosses another one or itself, of the same level or of
//   another. Points where lines touch stay.
// - A ring of three points or more keeps at least three.
// - A line may pass a ring or a cell of nodata on its other side, or cut such a cell, if it is within the
//   tolerance.
//
// Method: Douglas and Peucker 1973 with distances to segments; then segments that meet others are split at
// their farthest points until none is left, after Saalfeld 1999. Throws std::invalid_argument if the tolerance
// is negative or not finite.
void simplify_contours(std::vector<ContourLine>& lines, double tolerance_posts, int threads);

}  // namespace vpe::map
