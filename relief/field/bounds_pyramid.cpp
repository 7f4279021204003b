#include "relief/field/bounds_pyramid.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace relief {

namespace {

float rounded_down(double value) {
  const float near = static_cast<float>(value);
  return static_cast<double>(near) <= value ? near
                                            : std::nextafter(near, -std::numeric_limits<float>::infinity());
}

float rounded_up(double value) { return -rounded_down(-value); }

}  // namespace

BoundsPyramid::BoundsPyramid(int columns, int rows, const std::vector<Interval>& cells) {
  if (columns < 1 || rows < 1 ||
      cells.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("a pyramid of bounds: the cells do not fill the grid");
  Level level{static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), {}};
  level.pairs.reserve(cells.size());
  for (const Interval& cell : cells) level.pairs.push_back({rounded_down(cell.low), rounded_up(cell.high)});
  levels_.push_back(std::move(level));
  while (levels_.back().pairs.size() > 1) {
    const Level& below = levels_.back();
    Level above{(below.columns + 1) / 2, (below.rows + 1) / 2, {}};
    above.pairs.resize(above.columns * above.rows,
                       {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()});
    for (std::size_t j = 0; j < below.rows; ++j) {
      for (std::size_t i = 0; i < below.columns; ++i) {
        const Pair& from = below.pairs[j * below.columns + i];
        Pair& to = above.pairs[j / 2 * above.columns + i / 2];
        to = {std::min(to.low, from.low), std::max(to.high, from.high)};
      }
    }
    levels_.push_back(std::move(above));
  }
}

}  // namespace relief
