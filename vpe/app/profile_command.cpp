#include "paging/profile.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "vpe/app/places.h"
#include "vpe/app/planet_argument.h"
#include "vpe/app/program.h"
#include "vpe/app/report.h"
#include "vpe/core/number.h"

namespace vpe::app {

namespace {

struct ProfileArguments {
  std::vector<std::string> places;
  double step_m = 0;
};

// Fine enough for a plot, not finer than the posts.
constexpr double kDefaultPoints = 1000;

double default_step_m(const paging::PlanetMeta& meta, const std::vector<mars::LonLat>& places) {
  double length_m = 0;
  for (std::size_t n = 1; n < places.size(); ++n) {
    length_m += mars::distance_rad(places[n - 1], places[n]) * meta.radius_m;
  }
  const double finest_m = lod::post_spacing_m(meta.finest_level, meta.tile.intervals(), meta.radius_m);
  return std::max(length_m / kDefaultPoints, finest_m);
}

nlohmann::json to_json(const paging::ProfilePoint& p) {
  using nlohmann::json;
  return {{"distance_m", p.distance_m},
          {"ground_distance_m", p.ground_distance_m},
          {"lon_deg", p.place.lon_deg},
          {"lat_deg", p.place.lat_deg},
          {"elevation_m", p.missing ? json() : json(p.height_m)},
          {"slope_deg", p.missing ? json() : json(p.slope_deg)},
          {"steepest_slope_deg", p.missing ? json() : json(p.cross_slope_deg)},
          {"place_given", p.waypoint}};
}

void print_csv(const paging::ProfilePoint& p) {
  std::printf("%.3f,%.3f,%s,%s,", p.distance_m, p.ground_distance_m,
              core::format_number(p.place.lon_deg).c_str(), core::format_number(p.place.lat_deg).c_str());
  if (p.missing) {
    std::printf(",,,%d\n", p.waypoint ? 1 : 0);
  } else {
    std::printf("%.3f,%.3f,%.3f,%d\n", p.height_m, p.slope_deg, p.cross_slope_deg, p.waypoint ? 1 : 0);
  }
}

void profile(const ProfileArguments& arguments, const Common& common) {
  auto [planet_name, places] = split_places(arguments.places);
  if (places.empty()) places = read_places(std::cin);
  if (places.size() < 2) throw UsageError("a profile takes at least two places, LON,LAT in degrees");
  const auto planet = open_planet(planet_name, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  std::vector<paging::ProfilePoint> points;
  try {
    points = paging::profile(surface, places,
                             arguments.step_m > 0 ? arguments.step_m : default_step_m(meta, places));
  } catch (const std::invalid_argument& e) {
    throw UsageError(e.what());
  }
  if (common.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const paging::ProfilePoint& p : points) list.push_back(to_json(p));
    print_json({{"datum", to_string(meta.datum)},
                {"radius_m", meta.radius_m},
                {"illustration", meta.illustration},
                {"resampling_max_m", meta.resampling.max_m},
                {"points", std::move(list)}});
    return;
  }
  std::printf(
      "distance_m,ground_distance_m,lon_deg,lat_deg,elevation_m,slope_deg,steepest_slope_deg,place_given\n");
  for (const paging::ProfilePoint& p : points) print_csv(p);
}

}  // namespace

void add_profile(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ProfileArguments>();
  CLI::App* command =
      add_command(program, "profile", "Heights, slopes and distances along great circles", common, true);
  command->add_option(
      "PLANET_AND_PLACES", arguments->places,
      "[PLANET] LON,LAT LON,LAT... (degrees east, north); places from stdin when none is given");
  command
      ->add_option("--step", arguments->step_m,
                   "Distance between points at most, metres (default: 1000 points)")
      ->check(number_within(0.001, 1e7));
  command->callback([arguments, &common] { profile(*arguments, common); });
}

}  // namespace vpe::app
