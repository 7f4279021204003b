// What a panorama shows at a place of its picture or in a direction.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "panorama/open_panorama.h"

namespace vpe::app {

struct ShownPlace {
  double x = 0;  // of the picture, pixel centres at +0.5
  double y = 0;
  panorama::Direction direction;
  // In the order of the planes; null where a plane has no value, as for sky.
  std::vector<std::pair<std::string, nlohmann::json>> values;
};

// Throws std::runtime_error that names the picture and what it shows, when it does not show the place.
ShownPlace place_at_pixel(const panorama::PanoramaDescription& description, double x, double y);
ShownPlace place_at(const panorama::PanoramaDescription& description, const panorama::Direction& direction);

nlohmann::json to_json(const ShownPlace& place);
// CSV, with the keys of the JSON; both of places of one description.
std::string csv_header(const ShownPlace& place);
std::string csv_line(const ShownPlace& place);

}  // namespace vpe::app
