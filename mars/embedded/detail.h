// Ground as seen from camera height: dunes and ripples, rocks, gravel, ledges of bedrock, patterned ground,
// clefts in lava.
#pragma once

#include "mars/embedded/block.h"
#include "mars/embedded/craters.h"
#include "mars/embedded/octaves.h"

namespace mars::embedded {

inline constexpr double kCoarsestSand_m = 128.0;  // largest spacing at which there are dunes
inline constexpr double kCoarsestDetail_m = 4.0;  // largest spacing at which add_detail() adds anything

// Sand: dunes, ridges and ripples with sharp crests across the wind.
struct Sand {
  static constexpr std::size_t kGroups = 3;
  alignas(64) Lane<float> cover;              // 0..1: share of the ground under sand
  alignas(64) Lane<float> height_m[kGroups];  // of dunes 640 m apart, of ridges 41 m apart, and of all ripples
  alignas(64) Lane<float> crest;              // 0 between the finest ridges present, 1 on their crests
};

// Sets `out`. Returns false if there is no sand; then only out.cover is set.
bool lay_sand(const Block& block, double detail_m, const Octaves& octaves, const Ground& ground,
              const CraterSum& craters, Sand& out);

// Rocks: angular blocks, partly buried, from pebbles of 6 cm to boulders of eight metres.
//
// Sizes follow the exponential cumulative area of Golombek and Rapp (1997), F(D) = k exp(-q D), with q = 1.79 +
// 0.152 / k at k = 0.35, the largest share that bare ground has; other ground buries some of the rocks.
struct Rocks {
  alignas(64) Lane<float> height_m;  // of rock above the ground around it, 0 = none
  alignas(64) Lane<float> tone;      // -1 dark .. 1 bright, of the visible rock
};

// Rocks shorter than this depend on `gravelly` instead of `bare`.
inline constexpr double kGravel_m = 0.5;

// Sets `out` to the rocks of diameters of detail_m and more. `bare` (0..1) is the share of them that stands
// out; `gravelly` is the same for those shorter than kGravel_m. A rock sinks gradually where the share
// decreases.
void strew_rocks(const Block& block, double detail_m, const Lane<float>& bare, const Lane<float>& gravelly,
                 Rocks& out);

struct Relief;

// Adds heights shorter than the octaves of roughness to the last group of `out`, sets its rocks, and adds to its grain.
// `smooth` are all heights of longer octaves, in metres; `rough` is the amplitude of roughness, 1 in the highlands.
void add_detail(const Block& block, double detail_m, const Ground& ground, const Octaves& octaves,
                const CraterSum& craters, const Lane<float>& rough, const Lane<float>& smooth, Relief& out);

}  // namespace mars::embedded
