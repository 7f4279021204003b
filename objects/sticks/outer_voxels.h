// Voxels that stick out of a surface, for voxelise.h.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/sticks/place_index.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// Returns a mark for each number of `index`, which holds the voxels of a surface: 1 for those that may be left out.
// Their centres lie outside, and behind the nearest place of the surface, along the axis next to its normal, is a
// voxel whose centre lies inside, or another one of the surface that stays. At edges of solids other directions count
// too. `inside` holds the voxels whose centres lie inside. `to_centres` leads from the nearest places to the centres,
// in voxels; zero: the voxel stays.
std::vector<std::uint8_t> outer_voxels(const VoxelGrid& inside, const PlaceIndex& index,
                                       const std::vector<glm::vec3>& to_centres);

}  // namespace objects
