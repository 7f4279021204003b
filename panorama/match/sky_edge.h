// The place of the sky's edge in one column of a photograph, to a fraction of a pixel. Private to panorama.
#pragma once

#include "vpe/core/image/image.h"

namespace panorama {

// Returns the row (pixels, from the upper edge) of the largest step near the upper edge of a cell. It is where the
// pixels' sum equals that of a sharp step between the two sides' levels. Brightness and colour count along their
// change. Neighbouring cells are averaged, so a sloping skyline is right to the second order.
double sky_edge_row(const vpe::core::RgbImage& image, int cell_px, int column, int row);

}  // namespace panorama
