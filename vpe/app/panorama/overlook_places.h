// Answers of `vpe overlook` to --direction and --at-pixel: what a panorama shows there.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "panorama/viewer/pixel_probe.h"

namespace vpe::app {

// Return what the panorama shows at a pixel or in a direction. Throw std::runtime_error with the image's extent
// if it does not show the place.
panorama::ProbeResult probe_pixel(const panorama::PanoramaDescription& description, double x, double y);
panorama::ProbeResult probe_direction(const panorama::PanoramaDescription& description,
                                      const panorama::Direction& direction);

nlohmann::json to_json(const panorama::ProbeResult& place);

// Return lines of CSV whose columns are the keys of the JSON. The header fits all places of one description.
std::string csv_header(const panorama::ProbeResult& place);
std::string csv_line(const panorama::ProbeResult& place);

}  // namespace vpe::app
