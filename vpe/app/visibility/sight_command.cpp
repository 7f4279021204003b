#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/feature_output.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/visibility/commands.h"
#include "vpe/base/number.h"
#include "vpe/explore/measure/line_of_sight.h"
#include "vpe/explore/results/path_results.h"

namespace vpe::app {

namespace {

constexpr double kMostSightHeight_m = 1e9;

struct SightArguments {
  std::string planet;
  std::string from;
  std::string to;
  double from_height_m = 2;
  double to_height_m = 0;
  std::string latitude;
  std::string output;
};

std::string sight_place(const mars::LonLat& place) {
  return base::format_number(place.lon_deg) + "," + base::format_number(place.lat_deg);
}

void print_sight(const explore::LineOfSight& sight, const explore::GroundAlong& ground,
                 const paging::PlanetMeta& meta) {
  std::printf("visible:         %s\n", sight.visible ? "yes" : "no");
  std::printf("distance:        %.3f m straight, %.3f m on the sphere\n", sight.distance_m, sight.arc_m);
  std::printf("clearance:       %.3f m at %s, %.3f m along the line\n", sight.clearance_m,
              sight_place(sight.clearance_place).c_str(), sight.clearance_distance_m);
  if (sight.obstruction) {
    std::printf("obstacle:        %s, %.3f m along the line, elevation %.3f m\n",
                sight_place(sight.obstruction->place).c_str(), sight.obstruction->distance_m,
                sight.obstruction->elevation_m);
  }
  if (std::isfinite(sight.needed_height_m)) {
    std::printf("needed height:   %.3f m above the ground of the second place\n", sight.needed_height_m);
  } else {
    std::printf("needed height:   none: the planet hides the first place from every height\n");
  }
  std::printf("datum:           %s\n", on_one_line(paging::describe_datum(meta)).c_str());
  std::printf("resolution:      posts %s to %s m apart\n",
              base::format_significant(ground.finest_spacing_m, 4).c_str(),
              base::format_significant(ground.coarsest_spacing_m, 4).c_str());
  const std::string resampling = ground.resampling_posts > 0
                                     ? "at most " + base::format_significant(ground.resampling_max_m, 4) + " m"
                                     : std::string("unknown");
  std::printf("error:           %s m of the clearance; ground against its sources' posts: %s\n",
              base::format_significant(sight.clearance_error_m, 2).c_str(), resampling.c_str());
  for (const std::string& source : ground.sources)
    std::printf("source:          %s\n", on_one_line(source).c_str());
  std::printf("nodata:          %s %% of the line\n",
              base::format_significant(100 * ground.nodata_share(), 3).c_str());
  std::printf("synthetic:       %s %% of the line\n",
              base::format_significant(100 * ground.synthetic_share(), 3).c_str());
}

void run_sight(const SightArguments& a, const Common& common) {
  check_feature_output(a.output, a.planet);
  const GivenPlace given_from = given_place("--from", a.from);
  const GivenPlace given_to = given_place("--to", a.to);
  const auto planet = open_planet(a.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  const explore::SightPoint from{place_on(given_from, "--from", a.latitude, meta, common.quiet),
                                 a.from_height_m};
  const explore::SightPoint to{place_on(given_to, "--to", a.latitude, meta, true), a.to_height_m};
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  explore::LineOfSight sight;
  try {
    sight = explore::line_of_sight(surface, from, to);
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("vpe sight: ") + e.what());
  }
  const std::array ends{from.place, to.place};
  const explore::GroundAlong ground = explore::ground_along(surface, ends);
  const nlohmann::json result = explore::sight_json(sight, from, to, ground, meta);
  if (!a.output.empty())
    mars::write_features(a.output, explore::sight_layer(result),
                         explore::result_info("sight: whether one place sees another", meta));
  if (common.json) {
    print_json(result);
  } else {
    print_sight(sight, ground, meta);
  }
}

}  // namespace

void add_sight(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<SightArguments>();
  CLI::App* command = add_command(program, "sight",
                                  "Tell whether one place sees another, and what is in the way", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("--from", arguments->from, "LON,LAT of the eye, degrees, or the name of its place")
      ->required();
  command->add_option("--to", arguments->to, "LON,LAT of what is looked at, degrees, or its name")->required();
  command->add_option("--from-height", arguments->from_height_m, "Height of the eye above the ground, metres")
      ->check(number_within(0, kMostSightHeight_m))
      ->capture_default_str();
  command->add_option("--to-height", arguments->to_height_m, "Height of the target above the ground, metres")
      ->check(number_within(0, kMostSightHeight_m))
      ->capture_default_str();
  add_latitude_option(*command, arguments->latitude);
  add_feature_output(*command, arguments->output, "Also write line, ends and obstacle as features");
  add_examples(*command, {{"from a mast to the ground",
                           "vpe sight mars.vpe --from 137.30,-4.60 --to 137.45,-4.75 --from-height 2"},
                          {"between two antennas, for a program",
                           "vpe sight mars.vpe --from 137.30,-4.60 --to 137.45,-4.75 --from-height 5 "
                           "--to-height 5 --json"},
                          {"line and obstacle for a geographic information system",
                           "vpe sight mars.vpe --from 137.30,-4.60 --to 137.45,-4.75 -o sight.gpkg"}});
  command->callback([arguments, &common] { run_sight(*arguments, common); });
}

}  // namespace vpe::app
