// Cells of a photograph: means of squares of its pixels, in which the sky is looked for. Private to panorama.
#pragma once

#include <vector>

#include "vpe/core/image/image.h"

namespace panorama {

// Holds brightness and colour (red less blue) of cells, row by row from the top.
struct SkyCells {
  int size_px = 1;  // side of a cell
  int columns = 0;
  int rows = 0;
  std::vector<float> brightness;
  std::vector<float> colour;
  // For each column the first row of data, and the first row of no data below it; rows where there is none.
  std::vector<int> first_row;
  std::vector<int> end_row;
  double brightness_noise = 1;  // standard deviation in the smoothest parts, at least that of whole numbers
  double colour_noise = 1;

  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

// Returns the cells of an image. Pixels up to nodata_level are no data; thin lines across them are, too.
SkyCells sky_cells(const vpe::core::RgbImage& image, int nodata_level);

// Returns, for each cell, how much the kSkyWindow cells from it downwards differ from those above, beyond what
// continues the change further above, in units of the noise above (that of the whole image at least). 0 where there are
// not kLeastSkyRows rows of data above and kSkyWindow from there on.
inline constexpr int kSkyWindow = 5;
inline constexpr int kLeastSkyRows = 2 * kSkyWindow;
std::vector<float> sky_contrast(const SkyCells& cells);

}  // namespace panorama
