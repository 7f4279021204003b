#include "vpe/voxel/volume/block_maxima.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vpe::voxel {

namespace {

constexpr double kSlackOfLevels = 1e-9;
constexpr std::int16_t kLowest = std::numeric_limits<std::int16_t>::lowest();

std::size_t cell_place(int i, int j, int columns) {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
}

}  // namespace

BlockMaxima::BlockMaxima(int columns, int rows, const std::vector<std::int16_t>& high)
    : columns_(columns), rows_(rows) {
  if (columns < 1 || rows < 1 ||
      high.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("maxima of blocks: the cells must fill the grid");
  // A point on the border of cells may be taken for one of either: neighbours count.
  Level first{columns, std::vector<std::int16_t>(high.size(), kLowest)};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      std::int16_t& most = first.high[cell_place(i, j, columns)];
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, rows - 1); ++y)
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, columns - 1); ++x)
          most = std::max(most, high[cell_place(x, y, columns)]);
    }
  }
  levels_.push_back(std::move(first));
  while (columns > 1 || rows > 1) {
    const Level& fine = levels_.back();
    const int half_columns = (columns + 1) / 2;
    const int half_rows = (rows + 1) / 2;
    Level coarse{half_columns, std::vector<std::int16_t>(cell_place(0, half_rows, half_columns), kLowest)};
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        std::int16_t& most = coarse.high[cell_place(i / 2, j / 2, half_columns)];
        most = std::max(most, fine.high[cell_place(i, j, columns)]);
      }
    }
    levels_.push_back(std::move(coarse));
    columns = half_columns;
    rows = half_rows;
  }
}

double BlockMaxima::first_low(const glm::dvec3& origin, const glm::dvec3& direction, double t0,
                              double t1) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  int level = static_cast<int>(levels_.size()) - 1;
  double t = t0;
  while (t < t1) {
    const int i = std::clamp(static_cast<int>(origin.x + t * direction.x), 0, columns_ - 1);
    const int j = std::clamp(static_cast<int>(origin.y + t * direction.y), 0, rows_ - 1);
    // Where the ray leaves the block that holds (i, j). One that has passed a side, but is so slow that rounding keeps it in the
    // block, stays beside that side, where maxima hold too.
    const auto leaves = [level, t](int cell, double from, double rate) {
      if (rate == 0) return kNever;
      const int block = cell >> level;
      const double at = (static_cast<double>((rate > 0 ? block + 1 : block) << level) - from) / rate;
      return at > t ? at : kNever;
    };
    const double end =
        std::min(t1, std::min(leaves(i, origin.x, direction.x), leaves(j, origin.y, direction.y)));
    const Level& blocks = levels_[static_cast<std::size_t>(level)];
    const int high = blocks.high[cell_place(i >> level, j >> level, blocks.columns)];
    const double lowest = origin.z + (direction.z < 0 ? end : t) * direction.z;
    // More than rounding above it.
    if (lowest >= high + 1 + kSlackOfLevels) {
      // A little beyond the border, so that the next block is another one; its neighbours' maxima cover the way.
      constexpr double kBeyond = 1e-9;
      t = end + kBeyond;
      level = std::min(level + 1, static_cast<int>(levels_.size()) - 1);
    } else if (level > 0) {
      --level;
    } else {
      if (!(direction.z < 0)) return t;
      // Where it comes down to the cell.
      return std::clamp((high + 1 + kSlackOfLevels - origin.z) / direction.z, t, end);
    }
  }
  return t1;
}

std::size_t BlockMaxima::bytes() const {
  std::size_t total = 0;
  for (const Level& level : levels_) total += level.high.capacity() * sizeof(std::int16_t);
  return total;
}

}  // namespace vpe::voxel
