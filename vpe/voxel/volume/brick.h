// Ground that no height grid can hold: overhangs, arches, pits with undercut walls, as a volume of its own.
//
// A brick takes the place of the terrain over a part of a face. What is solid there comes from its maker, column by column: the
// terrain itself with what stands on it, hangs over it or is dug into it.
//
// Typical usage:
//   const GridVolume brick = make_brick(face, frame, planet_radius_m, [&](const glm::dvec3& up, std::vector<SolidSpan>& out) {
//     out = {{-kDeep_m, ground_m(up)}, {arch_low_m(up), arch_high_m(up)}};
//   });
#pragma once

#include "vpe/base/parallel.h"
#include "vpe/core/ground_parts.h"
#include "vpe/voxel/volume/grid_volume.h"

namespace vpe::voxel {

using core::SolidsAt;
using core::SolidSpan;

// Limits of BrickSpec.
inline constexpr int kMostBrickSamples = 16;
// Densities of a brick: all between the ground and the highest part of each column.
inline constexpr std::size_t kMostBrickDensities = std::size_t{1} << 27;

struct BrickSpec {
  int samples = 4;  // along a side of each voxel's square; more: exacter densities, slower
  std::uint8_t threshold = 127;
};

// Makes the brick of a part of a face. The lowest solid part of every vertical must go on below everything that is to be seen: a
// brick is ground below all parts. Levels count from about the lowest part's top in the middle. The density of a voxel is the share of
// its cube that is solid, taken along samples * samples verticals; where those in the middles of neighbouring voxels have as many
// parts, which begin and end within a voxel, along verticals between them. Away from edges the surface lies within a voxel of what is solid; parts thinner than a voxel may be missing. Both
// deviations are 0: a brick is what it is. Throws std::invalid_argument for a frame of no or too many intervals, options beyond
// their limits, heights that are not finite, parts farther apart than kMostBandLevel voxels, and what `solids` throws;
// std::runtime_error for more than kMostBrickDensities.
// With `pool` several threads call `solids`; the brick is the same.
GridVolume make_brick(mars::Face face, const HeightGridFrame& frame, double radius_m, const SolidsAt& solids,
                      const BrickSpec& spec = {}, base::ThreadPool* pool = nullptr);

}  // namespace vpe::voxel
