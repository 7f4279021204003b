// A filter that smooths stair steps where one surface ends before another, in images with one sample a pixel.
#pragma once

#include <span>

#include "vpe/base/parallel.h"
#include "vpe/base/rgb.h"

namespace vpe::core {

// Smooths edges of the geometry in place. `colour` and `inverse_depth` have width * height values, top row
// first. inverse_depth is proportional to 1 / distance along the view axis, 0 = sky: it is linear over the
// image on every plane, at any slant, so its second difference shows an edge of the geometry and never of a
// texture. Where that is more than kEdgeBend of the value itself, the colour is averaged along the edge, whose
// direction is found from the gradient of brightness. All other pixels keep their colour. The result does not
// depend on the number of threads. Throws std::invalid_argument when sizes do not fit.
inline constexpr float kEdgeBend = 0.02F;
void smooth_edges(std::span<base::Rgb> colour, std::span<const float> inverse_depth, int width, int height,
                  base::ThreadPool& pool);

}  // namespace vpe::core
