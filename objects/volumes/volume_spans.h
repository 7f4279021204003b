// Stretches of a ray in the dense parts of a volume. A volume has no surface, so a threshold of its extinction says
// what is solid.
//
// Along a ray the field of a cell is a polynomial of degree three. It is cut at its extremes, between which it passes
// the threshold at most once, and that place is found by halving. So double and triple roots need no care of their
// own.
//
// Rounding opens no gaps where cells meet. Neighbours share the t of the face between them to the bit
// (visit_cells()), and a stretch that reaches a face ends or begins at that t. Whether it reaches it, each cell decides
// for itself; there, and at extremes, a value counts as at the threshold if it is at most kVolumeValueError below. The
// values of one place in two cells differ by less than that, so where the field is at the threshold or above, both
// decide alike.
//
// Typical usage:
//   const double threshold_per_m = default_threshold_per_m(model);
//   for (const SolidSpan& s : volume_spans(model.levels()[0], ray, 0, until, threshold_per_m)) tell(s.begin, s.end);
#pragma once

#include <vector>

#include "objects/model/solid_spans.h"
#include "objects/volumes/volume_march.h"
#include "objects/volumes/volume_model.h"

namespace objects {

// Bounds, in extinctions of a stored 1, how far below the threshold the field may be in a stretch of volume_spans(). It
// is above the rounding of a value in a lattice of VolumeLimits::kMostSide posts. For thresholds that are less than
// twice as large, half of the threshold takes its place.
inline constexpr double kVolumeValueError = 1e-9;

// Bounds, in edges of a cell, how long a gap is that volume_spans() closes and a stretch that it leaves out.
inline constexpr double kVolumeTouch_cells = 1e-9;

// Returns the stretches of a ray between two t, which may be infinite, in which the field of a level is at least a
// threshold, ascending; between any two of them it is below. Where the field passes the threshold, an end lies where the
// field is at it to 1e-9 of a stored 1: with a gradient of one a cell, to 1e-9 of a cell. Where the field only touches
// the threshold, or has a plateau there, values up to kVolumeValueError below it may be in a stretch. Rounding of the
// ray's coordinates adds some 1e-15 times the distance of its origin. A field of 0 is around the lattice, so a threshold
// of 0 or less is met on the whole ray. Meets nothing if the ray is not finite or its direction is 0. Empty bricks and
// cells are skipped. `level` must pass check(). Throws std::invalid_argument for a threshold that is not finite. Pure.
std::vector<SolidSpan> volume_spans(const VolumeLevel& level, const VolumeRay& ray, double begin, double end,
                                    double threshold_per_m);

// Returns the threshold of a model for which none is given: half of the largest extinction of a post of its finest
// level, above 0. Where a dense body falls to 0 within a spacing of posts, this puts the surface half way between
// them. Pure.
double default_threshold_per_m(const VolumeModel& model);

}  // namespace objects
