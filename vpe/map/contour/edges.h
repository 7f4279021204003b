// Contours as chains of crossed edges of the grid.
//
// The edge from post (column, row) to its right neighbour has the number 2 * (row * columns + column), the one
// to the post below it one more.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vpe/map/height_grid.h"

namespace vpe::map {

// Describes levels base + multiple * interval.
struct LevelScale {
  double base_m = 0;
  double interval_m = 1;

  double level_m(std::int64_t multiple) const { return base_m + static_cast<double>(multiple) * interval_m; }
  // Returns the smallest multiple whose level is above a height.
  std::int64_t first_above(double height_m) const;
};

// Holds a directed line as the edges that it crosses at one level.
struct EdgeChain {
  std::int64_t multiple = 0;
  bool is_closed = false;
  std::vector<std::uint64_t> edges;  // a closed chain does not repeat its first edge
};

// Returns the chains of the cells between rows `begin` and `end` (end > begin), joined inside these rows. Pure.
std::vector<EdgeChain> chains_of_rows(const HeightGrid& grid, const LevelScale& scale, int begin, int end);

// Joins open chains whose ends meet. Closed chains begin at their lowest edge. The result is ordered by level
// and first edge, so that it does not depend on how chains were divided. Pure.
std::vector<EdgeChain> join_chains(std::vector<EdgeChain> chains);

}  // namespace vpe::map
