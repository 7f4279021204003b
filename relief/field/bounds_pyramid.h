// Pyramids of least and largest values.
//
// Level 0 has a pair for each cell of a grid; every level above has one for 2 x 2 pairs of the level below, up to a single
// one (Vyatkin and Dolgovesov 2002, Fig. 2, where only the maxima are kept).
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "relief/field/interval_algebra.h"
#include "relief/shape.h"

namespace relief {

// Holds the pyramid of a grid. Immutable; every const function may be called from any number of threads at once.
class BoundsPyramid {
 public:
  // Makes a pyramid from one interval a cell, row by row. They are stored as floats, rounded outwards.
  BoundsPyramid(int columns, int rows, const std::vector<Interval>& cells);

  // Returns an interval that holds those of the cells from column i0 to i1 and row j0 to j1, all included. Takes the
  // finest level at which they lie in 2 x 2 pairs: the rule of the paper, 1 / 2^level against the extent L_p.
  Interval over(int i0, int i1, int j0, int j1) const {
    const unsigned extent = static_cast<unsigned>(i1 - i0 > j1 - j0 ? i1 - i0 : j1 - j0);
    const int shift = extent > 1 ? static_cast<int>(std::bit_width(extent - 1)) : 0;
    const Level& level = levels_[static_cast<std::size_t>(shift)];
    const std::size_t left = static_cast<std::size_t>(i0 >> shift);
    const std::size_t right = static_cast<std::size_t>(i1 >> shift);
    const Pair* low = &level.pairs[static_cast<std::size_t>(j0 >> shift) * level.columns];
    const Pair* high = &level.pairs[static_cast<std::size_t>(j1 >> shift) * level.columns];
    float least = low[left].low < low[right].low ? low[left].low : low[right].low;
    float most = low[left].high > low[right].high ? low[left].high : low[right].high;
    if (high != low) {
      least = std::min(least, std::min(high[left].low, high[right].low));
      most = std::max(most, std::max(high[left].high, high[right].high));
    }
    return {least, most};
  }

  // Returns an interval that holds all.
  Interval all() const {
    const Pair& top = levels_.back().pairs.front();
    return {top.low, top.high};
  }

  int levels() const { return static_cast<int>(levels_.size()); }

 private:
  struct Pair {
    float low = 0;
    float high = 0;
  };
  struct Level {
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::vector<Pair> pairs;
  };

  std::vector<Level> levels_;
};

}  // namespace relief
