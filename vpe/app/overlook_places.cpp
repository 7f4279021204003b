#include "vpe/app/overlook_places.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "panorama/look.h"
#include "panorama/raster_plane.h"
#include "panorama/viewer.h"
#include "vpe/core/number.h"

namespace vpe::app {

namespace {

using core::format_number;

// Names of the bands of planes whose meaning is known; others keep the plane's name.
std::vector<std::string> band_names(const std::string& plane, std::size_t bands) {
  if (plane == "range" && bands == 1) return {"range_m"};
  if (plane == "elevation" && bands == 1) return {"elevation_m"};
  if (plane == "lonlat" && bands == 2) return {"lon_deg", "lat_deg"};
  if ((plane == "slope" || plane == "incidence") && bands == 1) return {plane + "_deg"};
  std::vector<std::string> names;
  for (std::size_t band = 0; band < bands; ++band)
    names.push_back(bands == 1 ? plane : plane + "_" + std::to_string(band + 1));
  return names;
}

std::string extent(const panorama::PanoramaMap& map) {
  const panorama::ElevationRange range = panorama::elevations_of(map);
  const double left_deg = map.to_direction(0.0, map.horizon_px).azimuth_deg;
  return "it has " + std::to_string(map.width_px) + "x" + std::to_string(map.height_px) + " pixels, azimuths " +
         format_number(std::round(left_deg * 1e3) / 1e3) + " and " +
         format_number(std::round(std::min(map.azimuth_span_deg(), 360.0) * 1e3) / 1e3) +
         " degrees to the right, elevations " + format_number(std::round(range.low_deg * 1e3) / 1e3) + " to " +
         format_number(std::round(range.high_deg * 1e3) / 1e3);
}

void add_planes(const panorama::PanoramaDescription& description, ShownPlace& place) {
  const panorama::PanoramaMap& map = description.map;
  const auto column = std::clamp<std::int64_t>(static_cast<std::int64_t>(place.x), 0, map.width_px - 1);
  const auto row = std::clamp<std::int64_t>(static_cast<std::int64_t>(place.y), 0, map.height_px - 1);
  for (const panorama::PlaneName& name : description.planes) {
    const panorama::RasterPlane plane(description.picture.parent_path() / name.file, map.width_px, map.height_px);
    const std::vector<double> values = plane.at(column, row);
    const std::vector<std::string> names = band_names(name.name, values.size());
    for (std::size_t n = 0; n < values.size(); ++n) {
      const bool known = std::isfinite(values[n]);
      place.values.emplace_back(names[n], known ? nlohmann::json(values[n]) : nlohmann::json());
    }
  }
}

}  // namespace

ShownPlace place_at_pixel(const panorama::PanoramaDescription& description, double x, double y) {
  const panorama::PanoramaMap& map = description.map;
  if (!(x >= 0.0 && y >= 0.0 && x <= static_cast<double>(map.width_px) &&
        y <= static_cast<double>(map.height_px))) {
    throw std::runtime_error("--at-pixel " + format_number(x) + "," + format_number(y) + " is not in '" +
                             description.picture.string() + "': " + extent(map));
  }
  ShownPlace place{x, y, map.to_direction(x, y), {}};
  add_planes(description, place);
  return place;
}

ShownPlace place_at(const panorama::PanoramaDescription& description, const panorama::Direction& direction) {
  const auto shown = panorama::shown_place(description.map, direction);
  if (!shown) {
    throw std::runtime_error("--at " + format_number(direction.azimuth_deg) + "," +
                             format_number(direction.elevation_deg) + ": '" + description.picture.string() +
                             "' does not show it: " + extent(description.map));
  }
  // Of a picture that is a part of a pixel narrower than a turn the last column is the nearest.
  const double x = std::min(shown->x, static_cast<double>(description.map.width_px));
  ShownPlace place{x, shown->y, description.map.to_direction(x, shown->y), {}};
  add_planes(description, place);
  return place;
}

nlohmann::json to_json(const ShownPlace& place) {
  nlohmann::json json{{"x", place.x},
                      {"y", place.y},
                      {"azimuth_deg", place.direction.azimuth_deg},
                      {"elevation_deg", place.direction.elevation_deg}};
  for (const auto& [name, value] : place.values) json[name] = value;
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
    line += "," + (value.is_number() ? digits(value.get<double>(), is_place ? 10 : 3) : std::string());
  }
  return line;
}

}  // namespace vpe::app
