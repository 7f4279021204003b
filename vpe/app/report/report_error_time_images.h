// Images that are put together from others: larger ones averaged, smaller ones stretched, facets and cylinders
// looked up.
#pragma once

#include <vector>

#include "panorama/panorama_plan.h"
#include "vpe/report/error_time.h"

namespace vpe::app {

// The same view with `times` as many columns and rows, in strips of whole rows of it.
std::vector<core::DrawRequest> enlarged(const core::DrawRequest& request, int times);
// The mean of each `times` x `times` pixels of those strips, rounded; without ranges.
report::Compose average(const core::View& view, int times);

// The same view with `times` fewer columns and rows, or with a few pixels more on each side where they do not divide.
core::DrawRequest reduced(const core::DrawRequest& request, int times);
// That image drawn as large as the view, between its pixels linearly; without ranges.
report::Compose off_axis_magnification(const core::View& view, int times);

// A whole turn from 25 degrees below the horizon to 15 above it.
panorama::PanoramaMap cylinder_of(std::int64_t columns);
// columns: rounded to whole ones of each facet.
panorama::PanoramaMap facets_of(int facets, std::int64_t columns);

struct Standing {
  mars::Pose pose;
  double radius_m = mars::kMarsRadius_m;
  core::DrawRequest request;  // settings and sun
};
// What draws a map: its pieces from left to right.
std::vector<core::DrawRequest> requests_of(const panorama::PanoramaMap& map, const Standing& standing);
// An image of `onto` whose pixels are those of `map` that show their directions: the nearest ones, with their
// ranges. A map that is `onto` itself is taken as it is.
report::Compose resample(const panorama::PanoramaMap& map, const panorama::PanoramaMap& onto);

}  // namespace vpe::app
