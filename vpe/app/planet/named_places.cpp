#include "vpe/app/planet/named_places.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "mars/embedded/data_files.h"
#include "mars/geodesy/place_text.h"
#include "mars/geodesy/sphere.h"
#include "vpe/app/cli/program.h"
#include "vpe/explore/places/place_search.h"

namespace vpe::app {

std::vector<core::Place> read_places_of(const std::string& file) {
  if (!file.empty()) return explore::sights_first(core::read_gazetteer(file));
  const std::string own = mars::find_data_file(mars::kPlacesFile);
  if (own.empty())
    throw std::runtime_error(std::string("the list of names ") + mars::kPlacesFile +
                             " is not installed beside the program; give coordinates, or a list of your own");
  return explore::sights_first(core::read_gazetteer(own));
}

core::Place place_named(const std::string& option, const std::string& name) {
  constexpr std::size_t kNear = 6;
  const explore::PlaceSearch search(read_places_of(""));
  if (const core::Place* place = search.named(name)) return *place;
  const std::vector<const core::Place*> near = search.find(name, kNear);
  if (near.size() == 1) return *near.front();
  std::string names;
  for (const core::Place* place : near) names += (names.empty() ? "" : ", ") + place->name;
  throw UsageError(option + " '" + name + "': " +
                   (names.empty() ? "no place has such a name; 'vpe find' searches them"
                                  : "several names come near: " + names));
}

bool looks_like_name(const std::string& text) {
  if (text.empty() ||
      (std::isalpha(static_cast<unsigned char>(text[0])) == 0 && static_cast<unsigned char>(text[0]) < 0x80))
    return false;
  // "N 4.6 E 137", "lat 4", "nan" and the like are no names.
  return std::ranges::none_of(
      text, [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == ','; });
}

SightOfPlace sight_of(const core::Place& place, double planet_radius_m) {
  constexpr double kUsual_m = 20'000;
  constexpr double kWidest_m = 3'000'000;
  constexpr double kPitch_deg = -40;
  const double across_m = std::clamp(place.diameter_m > 0 ? place.diameter_m : kUsual_m, 1000.0, kWidest_m);
  const double distance_m = 1.3 * across_m;
  const double down_rad = -kPitch_deg * mars::kRadiansPerDegree;
  const double south_m = distance_m * std::cos(down_rad);
  const mars::LonLat from = mars::destination({place.lon_deg, place.lat_deg}, 180, south_m / planet_radius_m);
  const mars::LonLat at{place.lon_deg, place.lat_deg};
  return {from.lon_deg, from.lat_deg, mars::initial_bearing_deg(from, at),
          // The ground falls away from the level by the angle of the way.
          kPitch_deg - 0.5 * south_m / planet_radius_m / mars::kRadiansPerDegree,
          distance_m * std::sin(down_rad)};
}

}  // namespace vpe::app
