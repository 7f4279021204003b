// Colours of the embedded Mars: classical albedo features, dust and rock, polar frost.
#pragma once

#include "mars/embedded/surface.h"
#include "mars/sources/source.h"

namespace mars::embedded {

// sRGB of a block's ground; out has room for kBlock.
void colour(const Block& block, const Surface& surface, vpe::base::Rgb* out);

}  // namespace mars::embedded
