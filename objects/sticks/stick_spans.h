// Stretches of a line in the voxels of a model of sticks.
//
// Typical usage:
//   const std::vector<SolidSpan> spans = stick_spans(model.levels()[0], {origin_m, direction});
#pragma once

#include <vector>

#include "objects/model/solid_spans.h"
#include "objects/sticks/stick_model.h"

namespace objects {

// Bounds, in edges of a voxel, how long a gap is that stick_spans() closes and a stretch that it leaves out.
// Both come of rounding, or of a line that passes the edge of a voxel so closely.
inline constexpr double kStickTouch_voxels = 1e-6;

// Bounds, in edges of a voxel, the distance between an end of a stretch and the surface that was voxelised
// (voxelise.h): such an end lies on a side of a voxel that the surface passes through, and this is a voxel's
// diagonal.
inline constexpr double kStickSurfaceError_voxels = 1.7320508075688773;

// Gives, in edges of a voxel, a length of gaps that closes all notches between the steps of a voxelised plane that
// is slanted by up to 60 degrees against a plane across the line. Such a notch lies within a voxel's diagonal of
// the plane.
inline constexpr double kStickStep_voxels = 2 * kStickSurfaceError_voxels;

// Returns the stretches of a whole line in the solid voxels of a level, ascending; between any two of them is air.
// Solid are opaque voxels, and semi-transparent ones from kSolidOpacity (solid_spans.h) on. Voxels that follow each
// other along the line are one stretch, whatever columns they belong to. Gaps of at most `step_voxels` edges
// between voxels of different columns are closed: a slanted line passes such notches between the steps of voxels
// that stand for a smooth surface. Gaps in one stick are never closed. A line that only touches sides and edges
// meets nothing; one in the plane of a side is in the voxel above or to the right of it. Meets nothing if the line
// is not finite. Rounding moves ends by some 1e-15 times the distance of the origin. Takes time in proportion to
// the columns and runs on the way. `level` must pass check(). Pure.
std::vector<SolidSpan> stick_spans(const StickModel::Level& level, const ModelLine& line,
                                   double step_voxels = 0);

}  // namespace objects
