// Views with fewer pixels, and equality of views: helpers of FramePrefetcher (frame_prefetcher.h), which finds
// the tiles of a coming frame with few rays.
#pragma once

#include "vpe/core/view.h"

namespace vpe::voxel {

// Returns a view of the same scene with pixels `factor` times as wide and as tall. It reaches beyond the right
// and the bottom of `view` by less than one of its pixels. Requires factor >= 1.
core::View downsampled_view(const core::View& view, int factor);

// Returns true if the views are equal to the bit, so that their images are equal too.
bool same_view(const core::View& a, const core::View& b);

}  // namespace vpe::voxel
