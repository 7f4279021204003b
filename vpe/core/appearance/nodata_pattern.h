// Stripes of nodata ground, for backends that shade on the CPU: the pattern of
// vpe/gl/shaders/nodata_pattern.glsl.
#pragma once

#include <cstdint>

namespace vpe::core {

// Greys of nodata ground, 0 to 255.
inline constexpr double kNodataBright = 150;
inline constexpr double kNodataDark = 60;
inline constexpr double kNodataMean = 0.5 * (kNodataBright + kNodataDark);

// Grey of imagery where its sources have no data. Stripes over an image are its colours times their grey over
// this one, so that missing imagery has the plain greys.
inline constexpr std::uint8_t kMissingImagery = 128;

// Returns the grey of the stripes at a place. `along` is u + v of the face's chart there, `pixel` (at least 0)
// its change over a pixel. Periods are 12 to 24 pixels, as long as they are not shorter than 2^-22. Pure.
double nodata_grey(double along, double pixel);

}  // namespace vpe::core
