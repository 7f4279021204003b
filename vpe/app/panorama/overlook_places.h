// What a panorama shows at a place of its image or in a direction, as the command line asks and prints it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "panorama/viewer/pixel_probe.h"

namespace vpe::app {

using ShownPlace = panorama::ProbeResult;

// Throws std::runtime_error that names the image and what it shows, when it does not show the place.
ShownPlace place_at_pixel(const panorama::PanoramaDescription& description, double x, double y);
ShownPlace place_at(const panorama::PanoramaDescription& description, const panorama::Direction& direction);

nlohmann::json to_json(const ShownPlace& place);
// CSV, with the keys of the JSON; both of places of one description.
std::string csv_header(const ShownPlace& place);
std::string csv_line(const ShownPlace& place);

}  // namespace vpe::app
