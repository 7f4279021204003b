// Checks options, and prepares and finishes images, for all ways to carry one. Private to vpe/warp.
#pragma once

#include "vpe/base/parallel.h"
#include "vpe/warp/carried_image.h"
#include "vpe/warp/carry.h"

namespace vpe::warp {

// Throws std::invalid_argument for options beyond their limits.
void check_options(const CarryOptions& options);

// Gives an image its size, and makes all of its pixels open.
void prepare(int width, int height, bool has_colour, CarriedImage& image);

// Makes sure that the clear ranges of open pixels end before what is around them, and counts pixels by origin.
void finish(base::ThreadPool& pool, CarriedImage& image);

}  // namespace vpe::warp
