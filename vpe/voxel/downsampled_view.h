// A view with fewer pixels.
#pragma once

#include "vpe/core/view.h"

namespace vpe::voxel {

// What `view` sees, with pixels `times` as wide and as tall; to the right and at the bottom a little more.
core::View downsampled_view(const core::View& view, int times);

// Equal to the bit, so that their images are.
bool same_view(const core::View& a, const core::View& b);

}  // namespace vpe::voxel
