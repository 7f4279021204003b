// The broad shape of Mars: dichotomy, Tharsis, Hellas and everything else longer than some 600 km.
//
// A sum of kRelief_kernels compact bumps on a Fibonacci lattice, height_m = sum c_k (1 - chord^2 / reach^2)^3.
// The rounded coefficients were fitted once to the MOLA topography (Smith et al. 2001) with troughs and shields
// left out; root-mean-square difference of the fit: 365 m.
#pragma once

#include "mars/embedded_block.h"

namespace mars::embedded {

inline constexpr int kReliefKernels = 2000;
inline constexpr double kReliefReach = 0.165;  // chord on the unit sphere: 560 km

// Centre of a bump, unit.
glm::dvec3 relief_centre(int k);

// Sets out[i] to the broad height in metres at each direction. Sums run in the order of k.
void relief(const Block& block, Lane<double>& out);

}  // namespace mars::embedded
