// The ground as it looks from camera level: gravel, ledges of bedrock, patterned ground, clefts in lava.
#pragma once

#include "mars/embedded/rocks.h"
#include "mars/embedded/sand.h"
#include "mars/embedded/surface.h"

namespace mars::embedded {

inline constexpr double kCoarsestClose_m = 4.0;

// Adds what is shorter than the octaves of roughness, metres, to `sum`, which holds those; sets out.rock and
// out.rock_tone, and adds to `grain`. `rough`: amplitude of roughness, 1 in the highlands.
void look_closely(const Block& block, double detail_m, const Sand& sand, const Lane<float>& rough, Surface& out,
                  Lane<float>& sum, Lane<float>& grain);

}  // namespace mars::embedded
