// Colours of the embedded Mars: classical albedo features, dust and rock, polar frost.
#pragma once

#include "mars/embedded/surface.h"
#include "mars/sources/source.h"

namespace mars::embedded {

// Sets out[i] to the sRGB colour of the ground of a block. `out` must have room for kBlock colours.
void colour(const Block& block, const Surface& surface, vpe::base::Rgb* out);

}  // namespace mars::embedded
