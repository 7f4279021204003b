#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/places.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/explore/measure/profile.h"

namespace vpe::app {

namespace {

struct ProfileArguments {
  std::vector<std::string> places;
  std::string latitude;
  double step_m = 0;
};

nlohmann::json to_json(const paging::ProfilePoint& p) {
  using nlohmann::json;
  return {{"distance_m", p.distance_m},
          {"ground_distance_m", p.ground_distance_m},
          {"lon_deg", p.place.lon_deg},
          {"lat_deg", p.place.lat_deg},
          {"elevation_m", p.nodata ? json() : json(p.height_m)},
          {"slope_deg", p.nodata ? json() : json(p.slope_deg)},
          {"steepest_slope_deg", p.nodata ? json() : json(p.cross_slope_deg)},
          {"place_given", p.waypoint}};
}

void run_profile(const ProfileArguments& arguments, const Common& common) {
  auto [planet_name, places] = split_places(arguments.places);
  if (places.empty()) places = read_places(std::cin).places;
  if (places.size() < 2) throw UsageError("a profile needs at least two places, LON,LAT in degrees");
  const auto planet = open_planet(planet_name, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  make_planetocentric(places, arguments.latitude, meta, common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  explore::Profile profile;
  try {
    profile = explore::make_profile(surface, places, {.step_m = arguments.step_m});
  } catch (const std::invalid_argument& e) {
    throw UsageError(e.what());
  }
  if (common.json) {
    nlohmann::json list = nlohmann::json::array();
    double resampling_max_m = 0;
    std::int64_t compared = 0;
    for (const paging::ProfilePoint& p : profile.points) {
      list.push_back(to_json(p));
      const paging::ResamplingError here = paging::query(surface, p.place).resampling;
      resampling_max_m = std::max(resampling_max_m, here.max_m);
      compared += here.posts;
    }
    print_json({{"datum", to_string(meta.datum)},
                {"radius_m", meta.radius_m},
                {"illustration", meta.illustration},
                {"resampling_max_m", compared > 0 ? nlohmann::json(resampling_max_m) : nlohmann::json()},
                {"planet_resampling_max_m", meta.resampling.max_m},
                {"points", std::move(list)}});
    return;
  }
  std::fputs(explore::profile_csv_header().c_str(), stdout);
  for (const paging::ProfilePoint& p : profile.points) std::fputs(explore::profile_csv_line(p).c_str(), stdout);
}

}  // namespace

void add_profile(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ProfileArguments>();
  CLI::App* command =
      add_command(program, "profile", "Print heights, slopes and distances along great circles", common, true);
  command->add_option(
      "PLANET_AND_PLACES", arguments->places,
      "[PLANET] LON,LAT LON,LAT... (degrees east, north, or as 4.6S,222.6W); without places, they are "
      "read from stdin");
  add_latitude_option(*command, arguments->latitude);
  command
      ->add_option("--step", arguments->step_m,
                   "Largest distance between points, metres (default: 1000 points along the profile)")
      ->check(number_within(0.001, 1e7));
  add_examples(*command,
               {{"heights every 2 km along a great circle",
                 "vpe profile mars.vpe -70,-13 -60,-14 --step 2000 > profile.csv"},
                {"a way over three places", "vpe profile mars.vpe 137.30,-4.60 137.37,-4.67 137.45,-4.75"}});
  command->callback([arguments, &common] { run_profile(*arguments, common); });
}

}  // namespace vpe::app
