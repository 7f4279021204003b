// Fills the open pixels of a carried image where nothing can draw them: a panorama has no ground to cast.
//
// Typical usage:
//   carrier.carry(left, frame, right, options, pool, carried);
//   const std::int64_t filled = fill_open(carried);
#pragma once

#include <cstdint>

#include "vpe/warp/carried_image.h"

namespace vpe::warp {

// Gives each run of open pixels in a row the colour and the range of the farther of the two pixels beside it, or of the only one:
// what opens behind something near is most likely more of what is behind it. A row of open pixels alone takes the row above, or,
// at the top, the first row below that has others; an image of open pixels alone stays as it is. `origin` stays kOpen, so that
// such pixels can be told. Returns their number. Colours may be empty. Pure.
std::int64_t fill_open(CarriedImage& image);

}  // namespace vpe::warp
