// Colours as video stores them: a plane of luma and two of chroma at half the resolution (YUV 4:2:0).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vpe/base/rgb.h"

namespace vpe::app {

// Makes the three planes of an image, Y, U and V one after the other, row by row: BT.709 within the limits of television (luma 16
// to 235, chroma 16 to 240). A pixel of chroma is of the mean of 2 x 2 colours. Each value is within 0.52 of that of the exact
// formula, and the same on every instruction set. Throws std::invalid_argument for odd sides and sizes that do not fit.
//
// Typical usage:
//   std::vector<std::uint8_t> planes;                              // kept for the next frame
//   to_planar_420(frame.colour, frame.width, frame.height, planes);  // 1.5 bytes a pixel
void to_planar_420(std::span<const base::Rgb> pixels, int width, int height, std::vector<std::uint8_t>& planes);

}  // namespace vpe::app
