#include "panorama/horizon/stellarium.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/number.h"

namespace panorama {

namespace {

using vpe::base::format_fixed;

std::string one_line(std::string text) {
  for (char& c : text) c = c == '\n' || c == '\r' ? ' ' : c;
  return text;
}

// Used unless the skyline is lower, so that a horizon far below the horizontal stays ground.
constexpr double kDefaultMinimum_deg = -2;

}  // namespace

std::string stellarium_list(std::span<const GroundPoint> skyline) {
  std::string out = "# azimuth (clockwise from north) and elevation, degrees\n";
  for (const GroundPoint& p : skyline)
    out += format_fixed(p.direction.azimuth_deg, 6) + " " + format_fixed(p.direction.elevation_deg, 6) + "\n";
  return out;
}

std::string stellarium_ini(const StellariumPlace& place, std::span<const GroundPoint> skyline) {
  double lowest = kDefaultMinimum_deg;
  for (const GroundPoint& p : skyline) lowest = std::min(lowest, std::floor(p.direction.elevation_deg));
  return "[landscape]\n"
         "name = " +
         one_line(place.name) +
         "\n"
         "type = polygonal\n"
         "author = vpe\n"
         "description = Skyline of a terrain model, without refraction\n"
         "polygonal_horizon_list = " +
         kStellariumList +
         "\n"
         "polygonal_horizon_list_mode = azDeg_altDeg\n"
         "polygonal_angle_rotatez = 0\n"
         "minimal_altitude = " +
         format_fixed(lowest, 0) +
         "\n"
         "ground_color = 0.35,0.2,0.12\n"
         "horizon_line_color = 0.9,0.55,0.3\n"
         "\n"
         "[location]\n"
         "planet = " +
         one_line(place.planet) +
         "\n"
         "name = " +
         one_line(place.name) +
         "\n"
         "latitude = " +
         format_fixed(place.place.lat_deg, 8) +
         "\n"
         "longitude = " +
         format_fixed(place.place.lon_deg, 8) +
         "\n"
         "altitude = " +
         format_fixed(place.alt_m, 0) + "\n";
}

}  // namespace panorama
