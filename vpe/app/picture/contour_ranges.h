// The ground that contours are taken from: where an image is coarser than contours need, its camera's ranges
// are drawn again, finer. The image itself stays as it is.
#pragma once

#include <optional>
#include <vector>

#include "vpe/core/frame.h"

namespace vpe::app {

// Returns the request for the ranges that the contours of a drawn image need, or nullopt if there are none or
// the image is fine enough: its error is within overlay.contours.tolerance. Levels of detail, regions of
// interest and limits of triangles do not count: they are of the image. The same paging is asked for.
std::optional<core::DrawRequest> contour_request(const core::DrawRequest& request,
                                                 const core::DrawResult& drawn);

// Returns how far the ground of a result may be shifted in its image.
double shift_px(const core::Certificate& certificate);

}  // namespace vpe::app
