// The voxels around one.
//
// Typical usage:
//   for_each_in_cube(voxels, {x, y, z}, 2, [&](std::uint64_t place) { use(place); });
#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "objects/sticks/voxel_grid.h"
#include "objects/sticks/voxel_stretches.h"

namespace objects {

// Calls visit(place) for each set voxel that differs from `middle` by at most `reach` along each axis, itself too, in
// ascending order of places.
template <class Visit>
void for_each_in_cube(const VoxelGrid& voxels, const glm::ivec3& middle, int reach, const Visit& visit) {
  const StickGrid& g = voxels.grid();
  const glm::ivec3 low = glm::max(middle - reach, glm::ivec3(0));
  const glm::ivec3 high = glm::min(middle + reach, glm::ivec3(g.columns_x, g.columns_y, g.height) - 1);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const std::span<const std::uint64_t> column = voxels.bits(voxels.column(x, y));
      for (int z = next_bit(column, low.z, true); z <= high.z; z = next_bit(column, z + 1, true))
        visit(voxels.place(x, y, z));
    }
  }
}

}  // namespace objects
