// The panoramas of `vpe report error-time`: cylinders and facets of any size, compared at one resolution.
#pragma once

#include <vector>

#include "panorama/panorama_plan.h"
#include "vpe/report/error_time.h"

namespace vpe::app {

// Return maps of a full circle from 25 degrees below the horizon to 15 above it. Facets have whole columns, so
// that their total is rounded.
panorama::PanoramaMap cylinder_of(std::int64_t columns);
panorama::PanoramaMap facets_of(int facets, std::int64_t columns);

// A camera, and how it draws.
struct PanoramaView {
  mars::Pose pose;
  double radius_m = mars::kMarsRadius_m;
  core::DrawRequest request;  // settings and sun
};

// Returns the requests that draw a map: its pieces from left to right.
std::vector<core::DrawRequest> requests_of(const panorama::PanoramaMap& map, const PanoramaView& view);

// Joins the pieces of a map that requests_of() has listed, with ranges if the frames have them. Throws std::invalid_argument for
// another number of frames.
core::Frame mosaic(const panorama::PanoramaMap& map, const std::vector<core::Frame>& frames);

// Makes an image of `onto`: each pixel is the nearest one of `map` in its direction, with its range. A map
// equal to `onto` is taken unchanged. Takes the frames of requests_of() and holds one at a time; throws
// std::invalid_argument for another number of them.
report::Compose resample(const panorama::PanoramaMap& map, const panorama::PanoramaMap& onto);

}  // namespace vpe::app
