// The 2-D array of boundary cells of a terrain volume (Wan, Qu and Kaufman 1999, section 3).
//
// Cell (i, j, k) has the voxels (i, j, k) to (i + 1, j + 1, k + 1) as corners. It is a boundary cell if some of them are ground and
// some are not. Of each column of cells the array keeps the lowest and the highest boundary cell: two bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "vpe/voxel/volume/block_maxima.h"
#include "vpe/voxel/volume/terrain_volume.h"

namespace vpe::voxel {

// Says what a cell is by the array: all cells above the highest boundary cell are air, those below the lowest one ground.
enum class CellFlag : std::uint8_t { kAir, kBoundary, kGround };

class BoundaryCells {
 public:
  // Scans a volume. Throws std::invalid_argument for a column of cells without a boundary cell.
  explicit BoundaryCells(const TerrainVolume& volume);

  struct Span {
    std::uint8_t low = 0;
    std::uint8_t high = 0;
  };
  // Returns the boundary cells of column (i, j), 0 <= i < columns(), 0 <= j < rows().
  const Span& span(int i, int j) const {
    return spans_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(i)];
  }
  CellFlag flag(int i, int j, int k) const {
    const Span& column = span(i, j);
    return k > column.high ? CellFlag::kAir : k < column.low ? CellFlag::kGround : CellFlag::kBoundary;
  }
  int columns() const { return columns_; }
  int rows() const { return rows_; }

  // Returns the size of the array, without the maxima that only first_low() uses.
  std::size_t bytes() const { return spans_.size() * sizeof(Span); }

  // Returns the first parameter t in [t0, t1] from which on a ray may be in a cell that is not air, or t1: all points before
  // it are certainly in air. Goes over square blocks of 2^n cells and skips those that the ray passes above.
  double first_low(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1) const {
    return maxima_->first_low(origin, direction, t0, t1);
  }

 private:
  int columns_;
  int rows_;
  std::vector<Span> spans_;
  std::optional<BlockMaxima> maxima_;
};

}  // namespace vpe::voxel
