// Says how the terrain volumes of a planet are made and cast: rays.mode=volume and boundary.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "vpe/core/ground_parts.h"
#include "vpe/voxel/volume/grid_volume.h"

namespace vpe::voxel {

// Says how the volumes of a planet are made and cast.
struct VolumeForm {
  BandSpec band = {};
  double interval = 0.6;  // of samples, voxels, 0.01 to 10. Smaller: narrower ridges are met, slower
  // Tiles that are nearer to the camera are cast by their densities, the others by boundary cells alone. 0: no densities.
  double near_m = std::numeric_limits<double>::infinity();
  // Is added to the ground or cut out of it; null: nothing. Drawn with bricks, which BrickStore makes.
  std::shared_ptr<const core::GroundParts> parts = {};
  // Take the place of the terrain (brick.h); a few, which do not overlap. Those of `parts` come after them.
  std::vector<std::shared_ptr<const GridVolume>> bricks = {};
  bool operator==(const VolumeForm&) const = default;
};

}  // namespace vpe::voxel
