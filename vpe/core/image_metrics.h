// How far an image is from another one of the same view: colours, ranges and the skyline, without knowing S
// (metrics.h has the shift of pixels against S).
//
// Row 0 is the top, rows follow each other. All functions are pure; they throw std::invalid_argument when sizes
// do not fit.
#pragma once

#include <cstdint>
#include <span>

#include "mars/sources/source.h"

namespace vpe::core {

// Root of the mean squared difference over pixels and channels, in steps of 8-bit sRGB (0 to 255).
double colour_rms(std::span<const base::Rgb> a, std::span<const base::Rgb> b);

// Mean structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004): windows of 11 x 11 under a Gaussian
// of 1.5 pixels that lie inside of the image, K1 = 0.01, K2 = 0.03, on the luma 0.299 R + 0.587 G + 0.114 B
// of 0 to 255. 1 for equal images, else less. Both sides must be at least 11.
double structural_similarity(std::span<const base::Rgb> a, std::span<const base::Rgb> b, int width, int height);

struct Spread {
  std::int64_t count = 0;  // with 0 all else is 0
  double median = 0;       // as in ShiftSummary: the smallest that at least this share does not exceed
  double p99 = 0;
  double max = 0;
};

// |a - b| / b where both images show a surface.
Spread range_error(std::span<const float> range_m, std::span<const float> reference_m);

// The skyline of a column is its topmost surface pixel's row, or the image's height where there is none. In
// columns where at least one image has sky above its surface, or where one has surface and the other none: by
// how many rows both differ.
Spread skyline_shift_px(std::span<const float> range_m, std::span<const float> reference_m, int width,
                        int height);

}  // namespace vpe::core
