// The difference between two images of the same view: colours, ranges and skylines. Needs no reference surface
// (metrics.h measures the shift of pixels against that).
//
// Row 0 is the top, rows follow each other. All functions are pure. They throw std::invalid_argument if the
// sizes do not fit.
#pragma once

#include <cstdint>
#include <span>

#include "vpe/base/rgb.h"

namespace vpe::core {

// Returns the root of the mean squared difference over pixels and channels, in steps of 8-bit sRGB (0 to 255).
double colour_rms(std::span<const base::Rgb> a, std::span<const base::Rgb> b);

// Returns the mean structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004): 1 for equal images, else
// less. Uses windows of 11 x 11 pixels inside the image under a Gaussian of 1.5 pixels, K1 = 0.01, K2 = 0.03,
// and the luma 0.299 R + 0.587 G + 0.114 B of 0 to 255. Both sides must be at least 11.
double structural_similarity(std::span<const base::Rgb> a, std::span<const base::Rgb> b, int width, int height);

// Summarizes a set of differences. Quantiles are by nearest rank (base::sorted_quantile_rank).
struct Spread {
  std::int64_t count = 0;  // if 0, all other fields are 0
  double median = 0;
  double p99 = 0;
  double max = 0;
};

// Returns |a - b| / b over the pixels where both images show a surface.
Spread range_error(std::span<const float> range_m, std::span<const float> reference_m);

// Returns the difference of both skylines in rows. The skyline of a column is the row of its topmost surface
// pixel, or the image's height if there is none. Columns count if at least one image has sky above its surface,
// or if one image has a surface and the other none.
Spread skyline_shift_px(std::span<const float> range_m, std::span<const float> reference_m, int width,
                        int height);

}  // namespace vpe::core
