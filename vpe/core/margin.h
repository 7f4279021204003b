// Images with a margin, from which images of other cameras can be taken (vpe/warp).
#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "vpe/core/frame.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace vpe::core {

// Returns a perspective view whose image is larger by a margin on each side: the pixels of `view` are those from
// (margin_px.x, margin_px.y) on, with the same rays within kPixelRayError_rad. Expects that the view draws all of its image
// and that the margin is 0 or more.
View with_margin(const View& view, glm::ivec2 margin_px);

// Returns how far the images of other views reach beyond that of `view` on its sides, at most `most_px`: for points at
// `nearest_m` and for those at infinity. Perspective views.
glm::ivec2 margin_for(const View& view, std::span<const View> others, double nearest_m, glm::ivec2 most_px);

// Return the frame or the image without a margin.
Frame without_margin(const Frame& frame, glm::ivec2 margin_px);
RgbImage without_margin(RgbImage image, glm::ivec2 margin_px);

}  // namespace vpe::core
