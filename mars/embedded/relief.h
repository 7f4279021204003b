// The broad shape of Mars: dichotomy, Tharsis, Hellas and everything else longer than some 600 km.
//
// 2000 bumps of embedded_bumps.h. The rounded coefficients were fitted once to the MOLA topography (Smith et
// al. 2001) with troughs and shields left out; root-mean-square difference of the fit: 365 m.
#pragma once

#include "mars/embedded/block.h"

namespace mars::embedded {

inline constexpr double kReliefReach = 0.165;  // chord on the unit sphere: 560 km

// Sets out[i] to the broad height in metres at each direction.
void relief(const Block& block, Lane<double>& out);

}  // namespace mars::embedded
