// The second eye of a round panorama (omnidirectional stereo, panorama/stereo_eyes.h).
//
// Both eyes of a column look along tangents of one circle about the viewpoint, in opposite directions around it. A point at
// the distance h along its ray, seen from above, is as far along the ray of either eye, so it is in the same row of both
// images, and in columns that differ by twice the angle atan(r / h), r the circle's radius. The ray of the right eye passes
// only through points that rays of the left eye in the same row pass through. So rows are carried as those of a pair of
// perspective images are (carry.h), with atan(r / h) / r in the place of the inverse depth.
#pragma once

#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"
#include "vpe/warp/carried_image.h"
#include "vpe/warp/carry.h"

namespace vpe::warp {

// Describes a row of a round panorama.
struct RoundRow {
  double radius_m = 0;  // of the circle of the eyes: half their distance; 0: both see the same
  double level = 1;  // share of a ray's length that lies along the ground: the cosine of its elevation, above 0
};

// Describes the columns of a round panorama, all of the same angle.
struct RoundColumns {
  double px_per_turn = 0;  // > 0
  int count = 0;           // of the second eye's image
};

// Returns the number of columns that a left eye's image needs on the right of those of the right eye's: by how much ground at
// the range `nearest_m` moves in any row. On a full circle they are its first columns again.
int columns_beside(double px_per_turn, std::span<const RoundRow> rows, double nearest_m);

// Carries the left eye's image to the right eye. The image has `rows.size()` rows and at least `columns.count` columns;
// further ones lie on its right. Pixels are open whose rays could meet ground beside the image at the range
// options.nearest_m or farther away. Otherwise as Carrier::carry(): the same bounds, and the same to the bit for any number of threads. Rays that
// meet ground nearer than 5 radii are carried less exactly. Replaces `into`. Throws std::invalid_argument where sizes do not
// fit, and as Carrier::carry() for options.
void carry_round(const core::Frame& left, const RoundColumns& columns, std::span<const RoundRow> rows,
                 const CarryOptions& options, base::ThreadPool& pool, CarriedImage& into);

}  // namespace vpe::warp
