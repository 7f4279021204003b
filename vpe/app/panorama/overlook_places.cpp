#include "vpe/app/panorama/overlook_places.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "panorama/viewer/viewer.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using base::format_fixed;
using base::format_number;
using base::format_rounded;

std::string extent(const panorama::PanoramaMap& map) {
  const panorama::ElevationRange range = panorama::elevations_of(map);
  const double left_deg = map.to_direction(0.0, map.horizon_px).azimuth_deg;
  return "it has " + std::to_string(map.width_px) + "x" + std::to_string(map.height_px) + " pixels, azimuths " +
         format_rounded(left_deg, 3) + " and " + format_rounded(std::min(map.azimuth_span_deg(), 360.0), 3) +
         " degrees to the right, elevations " + format_rounded(range.low_deg, 3) + " to " +
         format_rounded(range.high_deg, 3);
}

}  // namespace

panorama::ProbeResult probe_pixel(const panorama::PanoramaDescription& description, double x, double y) {
  std::optional<panorama::ProbeResult> place = panorama::PixelProbe(description).at_pixel(x, y);
  if (place) return *std::move(place);
  throw std::runtime_error("--at-pixel " + format_number(x) + "," + format_number(y) + " is not in '" +
                           description.image.string() + "': " + extent(description.map));
}

panorama::ProbeResult probe_direction(const panorama::PanoramaDescription& description,
                                      const panorama::Direction& direction) {
  std::optional<panorama::ProbeResult> place = panorama::PixelProbe(description).at(direction);
  if (place) return *std::move(place);
  throw std::runtime_error("--direction " + format_number(direction.azimuth_deg) + "," +
                           format_number(direction.elevation_deg) + ": '" + description.image.string() +
                           "' does not show it: " + extent(description.map));
}

nlohmann::json to_json(const panorama::ProbeResult& place) {
  nlohmann::json object{{"x", place.x},
                        {"y", place.y},
                        {"azimuth_deg", place.direction.azimuth_deg},
                        {"elevation_deg", place.direction.elevation_deg}};
  for (const auto& [name, value] : place.values)
    object[name] = value ? nlohmann::json(*value) : nlohmann::json();
  return object;
}

std::string csv_header(const panorama::ProbeResult& place) {
  std::string line = "x,y,azimuth_deg,elevation_deg";
  for (const auto& [name, value] : place.values) line += "," + name;
  return line;
}

std::string csv_line(const panorama::ProbeResult& place) {
  // The tenth decimal of a longitude is a fraction of a millimetre.
  constexpr int kLonLatDecimals = 10;
  std::string line = format_fixed(place.x, 3) + "," + format_fixed(place.y, 3) + "," +
                     format_fixed(place.direction.azimuth_deg, 6) + "," +
                     format_fixed(place.direction.elevation_deg, 6);
  for (const auto& [name, value] : place.values) {
    const bool is_place = name == "lon_deg" || name == "lat_deg";
    line += "," + (value ? format_fixed(*value, is_place ? kLonLatDecimals : 3) : std::string());
  }
  return line;
}

}  // namespace vpe::app
