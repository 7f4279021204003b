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

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "vpe/voxel/volume/grid_volume.h"

namespace vpe::voxel {

// Holds a solid part of a vertical line, in metres above the sphere, `low_m` below `high_m`. Parts may overlap.
struct SolidSpan {
  double low_m = 0;
  double high_m = 0;
};

// Writes what is solid along the vertical of a unit direction. The lowest part must go on below everything that is to be seen: a
// brick is ground below all parts.
using SolidsAt = std::function<void(const glm::dvec3& up, std::vector<SolidSpan>& solids)>;

// Limits of BrickSpec.
inline constexpr int kMostBrickSamples = 16;

struct BrickSpec {
  int samples = 4;  // along a side of each voxel's square; more: exacter densities, slower
  std::uint8_t threshold = 127;
};

// Makes the brick of a part of a face. The density of a voxel is the share of its cube that is solid, taken along samples * samples
// verticals. Away from edges the surface lies within a voxel of what is solid; parts thinner than a voxel may be missing. Both
// deviations are 0: a brick is what it is. Throws std::invalid_argument for a frame of no or too many intervals, options beyond
// their limits, heights that are not finite, parts farther apart than kMostBandLevel voxels, and what `solids` throws.
GridVolume make_brick(mars::Face face, const HeightGridFrame& frame, double radius_m, const SolidsAt& solids,
                      const BrickSpec& spec = {});

}  // namespace vpe::voxel
