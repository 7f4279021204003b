#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/feature_output.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/places/places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/query_answers.h"
#include "vpe/app/scene/scene_library.h"
#include "vpe/base/parallel.h"
#include "vpe/explore/results/path_results.h"

namespace vpe::app {

namespace {

struct QueryArguments {
  std::vector<std::string> planet_and_places;
  std::string scene;
  std::string latitude;
  std::string output;
  bool all_surfaces = false;
  bool fail_on_nodata = false;
};

// Returns the objects of a scene file; none without one.
PlacedScene objects_on(const paging::Surface& surface, const std::string& file, bool quiet) {
  if (file.empty()) return {};
  SceneLibrary library(surface);
  PlacedScene placed = library.scene(file, 1, 0);
  if (!quiet) {
    for (const std::string& note : library.take_notes()) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
  }
  return placed;
}

// Finds what lies on the ground of the answers: the highest object, and all surfaces if they are asked for.
void add_objects(const QueryArguments& arguments, const paging::Surface& surface,
                 const std::vector<mars::LonLat>& places, bool quiet, base::ThreadPool& pool,
                 QueryAnswers& answers) {
  const PlacedScene placed = objects_on(surface, arguments.scene, quiet);
  if (placed.scene != nullptr) answers.tops.emplace(places.size());
  if (arguments.all_surfaces) answers.surfaces.emplace(places.size());
  if (!answers.tops && !answers.surfaces) return;
  const double radius_m = surface.planet_radius_m();
  pool.run(places.size(), [&](std::size_t n) {
    const paging::PlaceAnswer& a = answers.ground[n];
    if (answers.tops) (*answers.tops)[n] = highest_object(*placed.scene, places[n], radius_m);
    if (answers.surfaces)
      (*answers.surfaces)[n] =
          surfaces_at(placed, places[n], {a.elevation_m, a.geometric_error_m, a.nodata}, radius_m);
  });
}

void query(const QueryArguments& arguments, const Common& common) {
  const PlanetAndPlaces request = split_places(arguments.planet_and_places);
  PlaceTable table;
  if (request.places.empty()) table = read_places(std::cin);
  check_feature_output(arguments.output, request.planet);
  const auto planet = open_planet(request.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  if (request.places.empty())
    make_planetocentric(table.places, arguments.latitude, meta, common.quiet);
  else
    table.places = places_on(request.places, arguments.latitude, meta, common.quiet);
  const std::vector<mars::LonLat>& places = table.places;
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);

  // Answers are computed tile by tile, in Morton order, and printed in the order of the request.
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const int level = meta.finest_level;
  std::vector<std::int64_t> position(places.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    position[n] = lod::pack(lod::tile_at(mars::chart_point(mars::direction(places[n])), level));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return position[a] < position[b]; });
  QueryAnswers answers;
  answers.ground.resize(places.size());
  constexpr std::size_t kChunk = 2048;
  base::ThreadPool pool(common.threads);
  pool.run((order.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(order.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i)
      answers.ground[order[i]] = paging::query(surface, places[order[i]]);
  });

  add_objects(arguments, surface, places, common.quiet, pool, answers);
  if (common.json || !arguments.output.empty()) {
    const nlohmann::json result = answers_json(answers, table, meta);
    if (!arguments.output.empty())
      mars::write_features(arguments.output, answers_layer(result),
                           explore::result_info("query: the ground at places", meta));
    if (common.json) print_json(result);
  }
  if (!common.json) print_csv_answers(answers, table, meta);
  const auto without =
      std::count_if(answers.ground.begin(), answers.ground.end(), [](const auto& a) { return a.nodata; });
  if (arguments.fail_on_nodata && without > 0)
    throw std::runtime_error(std::to_string(without) + " of " + std::to_string(places.size()) +
                             " places have no data");
}

}  // namespace

void add_query(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<QueryArguments>();
  CLI::App* command = add_command(
      program, "query", "Print elevation, slope, level (from 0), source and error at places", common, true);
  command->add_option(
      "PLANET_AND_PLACES", arguments->planet_and_places,
      "[PLANET] LON,LAT... (degrees east, north, or as 4.6S,222.6W, or names); without places, they are read "
      "from stdin, one a line or as a table with columns lon and lat");
  add_latitude_option(*command, arguments->latitude);
  command->add_option(
      "--with-objects", arguments->scene,
      "Scene file: answers name the highest object at a place, and the height of its top above the sphere");
  command->add_flag(
      "--all-surfaces", arguments->all_surfaces,
      "Print every surface along the vertical through a place, from the highest to the lowest: the "
      "ground, and tops and undersides of the objects of --with-objects");
  add_feature_output(*command, arguments->output, "Also write the places and the answers as features");
  command->add_flag("--fail-on-nodata", arguments->fail_on_nodata,
                    "Exit with status 1 after the answers if a place has no data");
  add_examples(*command, {{"two places, longitude first", "vpe query mars.vpe -59.2,-13.7 226.875,17.375"},
                          {"a place as on maps", "vpe query mars.vpe 13.7S,59.2W"},
                          {"at a landing site", "vpe query mars.vpe Curiosity"},
                          {"the ground as one of all surfaces; --with-objects SCENE adds those of objects",
                           "vpe query mars.vpe --all-surfaces -59.2,-13.7"},
                          {"a table of places with a header that names lon and lat",
                           "vpe query mars.vpe --json < places.csv"},
                          {"the same as points for a geographic information system",
                           "vpe query mars.vpe -o places.gpkg < places.csv > answers.csv"}});
  command->callback([arguments, &common] { query(*arguments, common); });
}

}  // namespace vpe::app
