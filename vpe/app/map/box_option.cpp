#include "vpe/app/map/box_option.h"

#include <algorithm>
#include <cmath>

#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/places/named_places.h"
#include "vpe/base/number.h"

namespace vpe::app {

map::PlaceBox parse_box(const std::string& text) {
  if (text.empty()) return {};
  if (is_name(text)) {
    const core::Place place = place_named("--box", text);
    if (!(place.diameter_m > 0))
      throw UsageError("--box '" + text + "': " + place.name +
                       " has no diameter; give WEST,SOUTH,EAST,NORTH in degrees around " +
                       base::format_number(place.lon_deg) + "," + base::format_number(place.lat_deg));
    return box_around({place.lon_deg, place.lat_deg}, place.diameter_m, mars::kMarsRadius_m);
  }
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 4)
    throw UsageError("--box '" + text +
                     "': expected WEST,SOUTH,EAST,NORTH in degrees, as 137,-6,138.5,-4, or a name");
  map::PlaceBox box{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  if (std::abs(box.west_deg) > 360 || std::abs(box.east_deg) > 360)
    throw UsageError("--box '" + text + "': longitudes must lie within -360 to 360");
  if (!(box.south_deg >= -90 && box.south_deg < box.north_deg && box.north_deg <= 90))
    throw UsageError("--box '" + text + "': latitudes must ascend and lie within -90 to 90");
  while (box.east_deg <= box.west_deg) box.east_deg += 360;
  if (box.east_deg - box.west_deg > 360)
    throw UsageError("--box '" + text + "': is more than 360 degrees wide");
  return box;
}

map::PlaceBox box_around(mars::LonLat middle, double diameter_m, double planet_radius_m) {
  const double arc_deg = diameter_m / 2 / planet_radius_m / mars::kRadiansPerDegree;
  map::PlaceBox box;
  box.south_deg = std::max(middle.lat_deg - arc_deg, -90.0);
  box.north_deg = std::min(middle.lat_deg + arc_deg, 90.0);
  // Meridians touch a circle farther from the equator than its middle lies.
  const double share =
      std::sin(arc_deg * mars::kRadiansPerDegree) / std::cos(middle.lat_deg * mars::kRadiansPerDegree);
  if (box.south_deg <= -90 || box.north_deg >= 90 || !(share < 1)) return box;
  const double half_deg = std::asin(share) / mars::kRadiansPerDegree;
  box.west_deg = middle.lon_deg - half_deg;
  box.east_deg = middle.lon_deg + half_deg;
  return box;
}

void require_planet_of_box(const std::string& text, const paging::PlanetMeta& meta) {
  if (!text.empty() && is_name(text)) require_mars_for_name("--box", text, meta);
}

}  // namespace vpe::app
