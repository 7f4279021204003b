#include "vpe/app/panorama/overlook_places.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "panorama/viewer/viewer.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using base::format_number;

std::string extent(const panorama::PanoramaMap& map) {
  const panorama::ElevationRange range = panorama::elevations_of(map);
  const double left_deg = map.to_direction(0.0, map.horizon_px).azimuth_deg;
  return "it has " + std::to_string(map.width_px) + "x" + std::to_string(map.height_px) + " pixels, azimuths " +
         format_number(std::round(left_deg * 1e3) / 1e3) + " and " +
         format_number(std::round(std::min(map.azimuth_span_deg(), 360.0) * 1e3) / 1e3) +
         " degrees to the right, elevations " + format_number(std::round(range.low_deg * 1e3) / 1e3) + " to " +
         format_number(std::round(range.high_deg * 1e3) / 1e3);
}

}  // namespace

ShownPlace place_at_pixel(const panorama::PanoramaDescription& description, double x, double y) {
  std::optional<ShownPlace> place = panorama::PixelProbe(description).at_pixel(x, y);
  if (place) return *std::move(place);
  throw std::runtime_error("--at-pixel " + format_number(x) + "," + format_number(y) + " is not in '" +
                           description.image.string() + "': " + extent(description.map));
}

ShownPlace place_at(const panorama::PanoramaDescription& description, const panorama::Direction& direction) {
  std::optional<ShownPlace> place = panorama::PixelProbe(description).at(direction);
  if (place) return *std::move(place);
  throw std::runtime_error("--at " + format_number(direction.azimuth_deg) + "," +
                           format_number(direction.elevation_deg) + ": '" + description.image.string() +
                           "' does not show it: " + extent(description.map));
}

nlohmann::json to_json(const ShownPlace& place) {
  nlohmann::json json{{"x", place.x},
                      {"y", place.y},
                      {"azimuth_deg", place.direction.azimuth_deg},
                      {"elevation_deg", place.direction.elevation_deg}};
  for (const auto& [name, value] : place.values) json[name] = value ? nlohmann::json(*value) : nlohmann::json();
  return json;
}

std::string csv_header(const ShownPlace& place) {
  std::string line = "x,y,azimuth_deg,elevation_deg";
  for (const auto& [name, value] : place.values) line += "," + name;
  return line;
}

std::string csv_line(const ShownPlace& place) {
  const auto digits = [](double value, int count) {
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", count, value);
    return std::string(text);
  };
  // Ten digits behind the point of a longitude are a fraction of a millimetre.
  std::string line = digits(place.x, 3) + "," + digits(place.y, 3) + "," +
                     digits(place.direction.azimuth_deg, 6) + "," + digits(place.direction.elevation_deg, 6);
  for (const auto& [name, value] : place.values) {
    const bool is_place = name == "lon_deg" || name == "lat_deg";
    line += "," + (value ? digits(*value, is_place ? 10 : 3) : std::string());
  }
  return line;
}

}  // namespace vpe::app
