// Smooths the stair steps of an image with one sample a pixel, where one surface ends before another.
#pragma once

#include <span>

#include "mars/sources/source.h"
#include "vpe/base/parallel.h"

namespace vpe::core {

// colour, inverse_depth: width * height, top row first. inverse_depth is proportional to 1 / distance along the
// view axis, 0 = sky: linear over the image on every plane, at any slant, so its second difference is an edge
// of the geometry and never of a texture. Where it is more than kEdgeBend of the value itself the colour is
// averaged along the edge, found from the gradient of brightness; all other pixels keep their colour. Does not
// depend on the number of threads. Throws std::invalid_argument when sizes do not fit.
inline constexpr float kEdgeBend = 0.02F;
void smooth_edges(std::span<base::Rgb> colour, std::span<const float> inverse_depth, int width, int height,
                  base::ThreadPool& pool);

}  // namespace vpe::core
