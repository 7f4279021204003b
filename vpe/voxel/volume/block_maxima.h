// Maxima of square blocks of cells, which lead rays past cells that they are certainly above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace vpe::voxel {

// Holds for each block of 2^n x 2^n cells of a grid the highest cell in and beside it: cells (i, j, k) with k above it hold air
// alone. Coordinates are those of a volume (terrain_volume.h). Immutable; any thread may read it.
class BlockMaxima {
 public:
  // Takes the highest cell of each column of cells, row by row. Throws std::invalid_argument if they do not fill the grid or it
  // is empty.
  BlockMaxima(int columns, int rows, const std::vector<std::int16_t>& high);

  // Returns the first parameter t in [t0, t1] from which on a ray may be in a cell that is not air, or t1: all points before
  // it are certainly in air. Columns of cells at the border are taken to go on beyond it.
  double first_low(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1) const;

  // Returns the highest cell of all.
  int highest() const { return levels_.back().high.front(); }
  std::size_t bytes() const;

 private:
  struct Level {
    int columns = 0;
    std::vector<std::int16_t> high;
  };

  int columns_;
  int rows_;
  std::vector<Level> levels_;  // levels_[0]: single cells
};

}  // namespace vpe::voxel
