// Sand: dunes, ridges and ripples with sharp crests across the wind.
#pragma once

#include "mars/embedded/block.h"
#include "mars/embedded/craters.h"
#include "mars/embedded/landforms.h"

namespace mars::embedded {

inline constexpr double kCoarsestSand_m = 128.0;  // spacing from which on no dune is there

struct Sand {
  alignas(64) Lane<float> cover;     // 0..1: share of the ground under sand
  alignas(64) Lane<float> height_m;  // of dunes and ripples
  alignas(64) Lane<float> crest;     // 0 between the finest ridges there are, 1 on their crests
};

// Sets out; false when there is no sand and out.cover alone is set.
bool lay_sand(const Block& block, double detail_m, const Octaves& octaves, const Terrain& ground,
              const CraterSum& craters, Sand& out);

}  // namespace mars::embedded
