// Which voxels a triangle passes through, and where.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace objects {

// Corners, in voxels from the corner of a grid: voxel (x, y, z) reaches from there to (x + 1, y + 1, z + 1).
using VoxelTriangle = std::array<glm::dvec3, 3>;

// Appends all voxels of a grid of this size, with their sides, that a triangle touches (separating axes,
// Akenine-Moller 2001), each once. The triangle should lie in the grid. Rounding may add a voxel that it misses by
// 1e-7, and never loses one. A triangle whose height is below 1e-9 of its longest edge touches none. Takes time in
// proportion to the voxels touched.
void append_voxels(const VoxelTriangle& triangle, const glm::ivec3& size, std::vector<glm::ivec3>& out);

// Returns the area, in squares of the edge, of the part of a triangle in a voxel. Pure.
double area_in_voxel(const VoxelTriangle& triangle, const glm::ivec3& voxel);

// Returns the weights of the second and third corner of the place of a triangle that is nearest to a point (Ericson
// 2005). Pure.
std::array<double, 2> nearest_weights(const VoxelTriangle& triangle, const glm::dvec3& point);

}  // namespace objects
