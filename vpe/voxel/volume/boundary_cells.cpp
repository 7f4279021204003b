#include "vpe/voxel/volume/boundary_cells.h"

#include <stdexcept>
#include <string>

namespace vpe::voxel {

BoundaryCells::BoundaryCells(const TerrainVolume& volume)
    : columns_(volume.columns() - 1), rows_(volume.rows() - 1) {
  spans_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      int low = -1;
      int high = -1;
      for (int k = 0; k + 1 < volume.levels(); ++k) {
        int ground = 0;
        for (int corner = 0; corner < 8; ++corner)
          ground += volume.is_ground(i + (corner & 1), j + ((corner >> 1) & 1), k + (corner >> 2)) ? 1 : 0;
        if (ground == 0 || ground == 8) continue;
        if (low < 0) low = k;
        high = k;
      }
      if (low < 0)
        throw std::invalid_argument("boundary cells: column " + std::to_string(i) + ", row " +
                                    std::to_string(j) + " of the volume has none");
      spans_.push_back({static_cast<std::uint8_t>(low), static_cast<std::uint8_t>(high)});
    }
  }
  std::vector<std::int16_t> high;
  high.reserve(spans_.size());
  for (const Span& column : spans_) high.push_back(column.high);
  maxima_.emplace(columns_, rows_, high);
}

}  // namespace vpe::voxel
