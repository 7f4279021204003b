// How far the surfaces of two meshes lie from each other: a bound that holds, not a sample.
//
// Typical usage:
//   const double geometric_error_m = hausdorff_bound(fine, coarse, 0.001);  // no point is farther
#pragma once

#include "objects/model/distance_tree.h"
#include "objects/model/mesh.h"

namespace objects {

// Returns an upper bound of the two-sided Hausdorff distance between the surfaces of two meshes: each point of
// either surface has a point of the other within it. The bound is at most tolerance_m or a twentieth, whichever
// is larger, above the distance, and the rounding of doubles at the size of the coordinates. Where that takes
// too much work, the bound is larger, and still holds. Triangles without area count as the segments or points
// that they are. Infinity if one mesh has no triangle, 0 if both have none. Pure; the same on every machine.
//
// The largest distance of a triangle from one triangle of the other mesh is at a corner, as the distance from a
// convex set is convex. Triangles whose bound by that is too large are divided where the nearest triangle
// changes.
double hausdorff_bound(const Mesh& a, const Mesh& b, double tolerance_m);
// Returns the same of trees that are already there.
double hausdorff_bound(const DistanceTree& a, const DistanceTree& b, double tolerance_m);

}  // namespace objects
