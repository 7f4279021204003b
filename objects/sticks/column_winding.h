// Which voxels have their centres inside of a mesh.
//
// Typical usage:
//   ColumnWinding winding(grid);
//   for (const VoxelTriangle& t : triangles) winding.add(t);
//   const VoxelGrid inside = winding.inside();
#pragma once

#include <cstdint>
#include <vector>

#include "objects/sticks/triangle_voxels.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// Counts how triangles wind around columns of voxels.
class ColumnWinding {
 public:
  explicit ColumnWinding(const StickGrid& grid) : grid_(grid) {}

  // Adds a triangle, in voxels from the corner of the grid. Of triangles with a common edge one is met there.
  void add(const VoxelTriangle& triangle);

  // Returns the voxels around whose centres the surface winds. Columns that it leaves open hold none.
  VoxelGrid inside() const;

 private:
  struct Crossing {
    std::uint32_t column = 0;
    float height = 0;
    int turn = 0;  // 1 where a line upwards enters the inside, -1 where it leaves it
  };

  StickGrid grid_;
  std::vector<Crossing> crossings_;
};

}  // namespace objects
