// Rocks: angular blocks, partly buried, from pebbles of a hand's breadth to boulders of eight metres.
//
// Sizes follow the exponential cumulative area of Golombek and Rapp (1997), F(D) = k exp(-q D), with
// q = 1.79 + 0.152 / k at k = 0.35, the most that bare ground gets; ground less bare buries the rest.
#pragma once

#include "mars/embedded/block.h"

namespace mars::embedded {

struct Rocks {
  alignas(64) Lane<float> height_m;  // of rock above the ground around it, 0 = none
  alignas(64) Lane<float> tone;      // -1 dark .. 1 bright, of the rock that shows
};

// Sets out to the rocks of diameters of detail_m and more. `bare` 0..1 says how many of them stand out, and
// `gravelly` how many of those shorter than kGravel_m; a rock goes under where that falls.
inline constexpr double kGravel_m = 0.5;
void strew_rocks(const Block& block, double detail_m, const Lane<float>& bare, const Lane<float>& gravelly,
                 Rocks& out);

}  // namespace mars::embedded
