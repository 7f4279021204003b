// Requests for larger and smaller images of a view, and functions that bring the images back to its size.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "vpe/report/error_time.h"

namespace vpe::report {

// Returns a black frame of this size, without ranges.
core::Frame blank_frame(const glm::ivec2& size);

// Returns requests for the same view with `factor` times as many columns and rows, in strips whose height is a multiple of
// `factor`: of kMostStripPixels at most where that is possible, and not higher than kMostStripRows.
inline constexpr int kMostStripPixels =
    1 << 21;  // larger: fewer strips, each of which takes some 50 bytes a pixel by rays
inline constexpr int kMostStripRows = 720;
std::vector<core::DrawRequest> enlarged(const core::DrawRequest& request, int factor);

// Averages each `factor` x `factor` pixels of those strips, one strip at a time, rounded to whole steps. Drops ranges.
Compose average(const core::View& view, int factor);

// Returns a request for the same view with `factor` times fewer columns and rows, rounded up: where the size is
// not a multiple, the image shows up to `factor` pixels of the view more.
core::DrawRequest reduced(const core::DrawRequest& request, int factor);

// Enlarges that image to the size of the view by linear interpolation. Drops ranges.
Compose magnified(const core::View& view, int factor);

}  // namespace vpe::report
