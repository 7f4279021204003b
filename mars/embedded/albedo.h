// Bright dust and dark sand: the named albedo features.
//
// A field of 8000 bumps (embedded_bumps.h), fitted once to the brightness of the Viking colour mosaic averaged
// over about 250 km: -1 the dark sand of Syrtis Major, 0 the mean, 1 the dust of Tharsis; residual 0.22. The
// fronts between bright and dark, and the streaks along them, are made up: sharp lines where the bent field
// passes a threshold.
#pragma once

#include "mars/embedded/block.h"
#include "mars/embedded/landforms.h"

namespace mars::embedded {

inline constexpr double kAlbedoReach = 0.083;  // chord on the unit sphere: 280 km

// Sets out[i] to the brightness of the ground, about -1.2..1.2, before what its relief does to it.
void albedo(const Block& block, const Octaves& octaves, Lane<float>& out);

}  // namespace mars::embedded
