// Panoramas for two eyes before they are drawn: checks, and the distance between the eyes.
#pragma once

#include "paging/surface/surface.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Throws UsageError for requests that one eye can have and two cannot.
void check_stereo_panorama(const PanoramaRequest& request);

// Returns the request's pair with its base and the range of the nearest ground, which it measures: it draws the
// panorama from the middle between the eyes with about a third of a degree a pixel. The request has stereo; a
// base_m of 0 becomes the comfortable one. `draw_request` has settings, sun and interest. Throws
// std::runtime_error for sky alone without a base, for eyes too far apart, and what the renderer throws.
panorama::EyePair measure_eyes(const PanoramaRequest& request, double radius_m,
                               const core::DrawRequest& draw_request, core::Renderer& renderer);

// Throws std::runtime_error if an eye is less than clearance_m above the ground at one of 720 azimuths.
void require_eyes_above_ground(const PanoramaRequest& request, const paging::Surface& surface,
                               double clearance_m);

}  // namespace vpe::app
