// Voxels from which the sky can be seen.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "objects/sticks/voxel_grid.h"

namespace objects {

// Up, and the eight steps that climb a voxel to a neighbouring column.
inline constexpr std::array<glm::ivec3, 9> kSkySteps = {
    {{0, 0, 1}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}}};

// Returns the empty voxels from which steps of kSkySteps leave the grid through empty ones only. Takes time in
// proportion to the grid: 64 voxels are worked on at once.
VoxelGrid sky_view(const VoxelGrid& filled, const glm::ivec3& step);

// Returns whether a voxel sees the sky, also one outside of the grid, which steps may lead into it. `view` is
// sky_view() of the step.
bool sees_sky(const VoxelGrid& view, glm::ivec3 voxel, const glm::ivec3& step);

}  // namespace objects
