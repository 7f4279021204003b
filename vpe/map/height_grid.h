// Heights at the posts of a rectangular map, in memory.
#pragma once

#include <cstddef>
#include <vector>

namespace vpe::map {

// Holds heights above the planet's zero at posts of equal spacing. Row 0 is the northern one, column 0 the western one.
// NaN is nodata.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  double spacing_m = 1;          // between neighbouring posts, in both directions
  std::vector<float> heights_m;  // by rows

  float at(int column, int row) const {
    return heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
  }
};

}  // namespace vpe::map
