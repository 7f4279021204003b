#include "vpe/app/places/named_places.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "mars/embedded/data_files.h"
#include "mars/geodesy/place_text.h"
#include "mars/geodesy/sphere.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/base/number.h"
#include "vpe/explore/places/arrival.h"
#include "vpe/explore/places/landing_sites.h"
#include "vpe/explore/places/place_search.h"

namespace vpe::app {

namespace {

bool begins_with_letter(const std::string& text) {
  if (text.empty()) return false;
  const auto first = static_cast<unsigned char>(text[0]);
  return std::isalpha(first) != 0 || first >= 0x80;
}

std::string list_of(const std::vector<const core::Place*>& places) {
  std::string names;
  for (const core::Place* place : places) names += (names.empty() ? "" : ", ") + place->name;
  return names;
}

}  // namespace

std::vector<core::Place> read_places_of(const std::string& file) {
  if (!file.empty()) return explore::sights_first(core::read_gazetteer(file));
  const std::string own = mars::find_data_file(mars::kPlacesFile);
  if (own.empty())
    throw std::runtime_error(std::string("the list of names ") + mars::kPlacesFile +
                             " is not installed beside the program; give coordinates, or a list of your own");
  std::vector<core::Place> places = explore::sights_first(core::read_gazetteer(own));
  const std::string landings = mars::find_data_file(explore::kLandingsFile);
  if (landings.empty()) return places;
  for (const explore::LandingSite& site : explore::read_landing_sites(landings))
    places.push_back(explore::to_place(site));
  return places;
}

core::Place place_named(const std::string& option, const std::string& name) {
  constexpr std::size_t kNear = 6;
  const explore::PlaceSearch search(read_places_of(""));
  if (const core::Place* place = search.named(name)) return *place;
  const std::vector<const core::Place*> near = search.find(name, kNear);
  // A name with a typing error is offered, and not taken: figures of another place would look like those that
  // were meant.
  const auto has_part = [&](const core::Place* place) {
    return explore::folded(place->name).find(explore::folded(name)) != std::string::npos;
  };
  const auto parts = std::ranges::count_if(near, has_part);
  if (parts == 1) return **std::ranges::find_if(near, has_part);
  const std::string names = list_of(near);
  throw UsageError(option + " '" + name + "': " +
                   (names.empty() ? "neither LON,LAT nor the name of a place; 'vpe find' searches names"
                    : parts > 1   ? "several names come near: " + names
                                  : "neither LON,LAT nor the name of a place; these come near: " + names));
}

bool looks_like_name(const std::string& text) {
  // "N 4.6 E 137", "lat 4", "nan" and the like are no names.
  return begins_with_letter(text) && std::ranges::none_of(text, [](char c) {
           return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == ',';
         });
}

bool is_listed_name(const std::string& text) {
  return begins_with_letter(text) && explore::PlaceSearch(read_places_of("")).named(text) != nullptr;
}

bool is_name(const std::string& text) { return looks_like_name(text) || is_listed_name(text); }

GivenPlace given_place(const std::string& option, const std::string& text) {
  std::string fault;
  if (const auto place = mars::parse_place(text, fault)) return {*place, "", 0};
  if (!is_name(text))
    throw UsageError(option + " '" + text + "': " + fault + ", or the name of a place of Mars");
  const core::Place place = place_named(option, text);
  return {{place.lon_deg, place.lat_deg}, place.name, place.diameter_m};
}

PlanetAndPlaces split_places(const std::vector<std::string>& arguments) {
  PlanetAndPlaces out;
  if (arguments.empty()) return out;
  const std::string& first = arguments.front();
  std::string fault;
  std::error_code none;
  const bool is_file = std::filesystem::exists(first, none);
  const std::optional<mars::LonLat> place = is_file ? std::nullopt : mars::parse_place(first, fault);
  const bool is_place = place || (!is_file && is_listed_name(first));
  if (!is_file && !is_place && first.find(',') != std::string::npos)
    throw UsageError("'" + first + "': neither a file nor a place; " + fault);
  if (is_place)
    out.places.push_back(given_place("place", first));
  else
    out.planet = first;
  for (std::size_t n = 1; n < arguments.size(); ++n) out.places.push_back(given_place("place", arguments[n]));
  return out;
}

mars::LonLat place_on(const GivenPlace& given, const std::string& option, const std::string& latitude,
                      const paging::PlanetMeta& meta, bool quiet) {
  if (given.name.empty()) return planetocentric(given.place, latitude, meta, quiet);
  require_mars_for_name(option, given.name, meta);
  return given.place;
}

std::vector<mars::LonLat> places_on(const std::vector<GivenPlace>& given, const std::string& latitude,
                                    const paging::PlanetMeta& meta, bool quiet) {
  std::vector<mars::LonLat> places;
  bool is_noted = quiet;
  for (const GivenPlace& place : given) {
    places.push_back(place_on(place, "place", latitude, meta, is_noted));
    is_noted = is_noted || place.name.empty();
  }
  return places;
}

void require_mars_for_name(const std::string& option, const std::string& name, const paging::PlanetMeta& meta) {
  constexpr double kSameRadius = 0.01;  // of it
  if (meta.body == "Mars" && std::abs(meta.radius_m / mars::kMarsRadius_m - 1) <= kSameRadius) return;
  throw UsageError(option + " '" + name + "': names of places are those of Mars, and this planet is " +
                   meta.body + " with a radius of " + base::format_number(meta.radius_m) +
                   " m; give coordinates");
}

SightOfPlace sight_of(const core::Place& place, double planet_radius_m) {
  constexpr double kWidest_m = 3'000'000;
  constexpr double kPitch_deg = -40;
  const double across_m = std::clamp(
      place.diameter_m > 0 ? place.diameter_m : explore::ArrivalLimits::kUnknown_m, 1000.0, kWidest_m);
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
