// Colours of the embedded Mars: classical albedo features, dust and rock, polar frost.
#pragma once

#include "mars/embedded_surface.h"
#include "mars/source.h"

namespace mars::embedded {

// sRGB of a block's ground; out has room for kBlock.
void colour(const Block& block, const Surface& surface, Rgb* out);

}  // namespace mars::embedded
