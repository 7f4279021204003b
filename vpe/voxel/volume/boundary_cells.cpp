#include "vpe/voxel/volume/boundary_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
  make_levels();
}

void BoundaryCells::make_levels() {
  // A point on the border of cells may be taken for one of either: neighbours count.
  Level first{columns_, std::vector<std::uint8_t>(spans_.size())};
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      std::uint8_t high = 0;
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, rows_ - 1); ++y)
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, columns_ - 1); ++x)
          high = std::max(high, span(x, y).high);
      first.high[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(i)] = high;
    }
  }
  levels_.push_back(std::move(first));
  int columns = columns_;
  int rows = rows_;
  while (columns > 1 || rows > 1) {
    const Level& fine = levels_.back();
    const int half_columns = (columns + 1) / 2;
    const int half_rows = (rows + 1) / 2;
    Level coarse{half_columns, std::vector<std::uint8_t>(static_cast<std::size_t>(half_columns) *
                                                         static_cast<std::size_t>(half_rows))};
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        std::uint8_t& high =
            coarse.high[static_cast<std::size_t>(j / 2) * static_cast<std::size_t>(half_columns) +
                        static_cast<std::size_t>(i / 2)];
        high = std::max(high, fine.high[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                                        static_cast<std::size_t>(i)]);
      }
    }
    levels_.push_back(std::move(coarse));
    columns = half_columns;
    rows = half_rows;
  }
}

double BoundaryCells::first_low(const glm::dvec3& origin, const glm::dvec3& direction, double t0,
                                double t1) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  int level = static_cast<int>(levels_.size()) - 1;
  double t = t0;
  while (t < t1) {
    const int i = std::clamp(static_cast<int>(origin.x + t * direction.x), 0, columns_ - 1);
    const int j = std::clamp(static_cast<int>(origin.y + t * direction.y), 0, rows_ - 1);
    // Where the ray leaves the block that holds (i, j).
    const auto leaves = [level](int cell, double from, double rate) {
      if (rate == 0) return kNever;
      const int block = cell >> level;
      return (static_cast<double>((rate > 0 ? block + 1 : block) << level) - from) / rate;
    };
    const double out = std::min(leaves(i, origin.x, direction.x), leaves(j, origin.y, direction.y));
    const double end = std::min(t1, std::max(out, t));
    const Level& blocks = levels_[static_cast<std::size_t>(level)];
    const int high =
        blocks.high[static_cast<std::size_t>(j >> level) * static_cast<std::size_t>(blocks.columns) +
                    static_cast<std::size_t>(i >> level)];
    const double lowest = origin.z + (direction.z < 0 ? end : t) * direction.z;
    // More than rounding above it.
    if (lowest >= high + 1 + 1e-9) {
      // A little beyond the border, so that the next block is another one; its neighbours' maxima cover the way.
      constexpr double kBeyond = 1e-9;
      t = end + kBeyond;
      level = std::min(level + 1, static_cast<int>(levels_.size()) - 1);
    } else if (level > 0) {
      --level;
    } else {
      return t;
    }
  }
  return t1;
}

}  // namespace vpe::voxel
