// Colours of the embedded Mars: the mosaic, and marks of the detail below its resolution.
#pragma once

#include "mars/embedded/surface.h"
#include "vpe/base/rgb.h"

namespace mars::embedded {

// Sets out[0..block.count). The mean over the area of a pixel of the mosaic is its colour to within a few grey values:
// what detail makes darker in one place it makes brighter in another. Stones and ripples, which only posts of some metres
// show, have colours of their own.
void colour(const Block& block, const MeasuredMars& mars, const Surface& s, vpe::base::Rgb* out);

}  // namespace mars::embedded
