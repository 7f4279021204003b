#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/geometric.hpp>
#include <iostream>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "objects/draw/single_ray.h"
#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/measured_part.h"
#include "vpe/app/planet/places.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/scene/scene_library.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

namespace {

nlohmann::json to_json(const paging::PlaceAnswer& a, const paging::PlanetMeta& meta, double measured_m) {
  const char* kind = kind_of(a, meta);
  using nlohmann::json;
  const auto value = [&](double x) { return a.nodata ? json() : json(x); };
  const mars::SourceInfo* source = source_of(a, meta);
  const bool has_error = a.resampling.posts > 0;
  json tile_sources = json::array();
  for (const int s : a.tile_sources) tile_sources.push_back(meta.sources.at(static_cast<std::size_t>(s)).name);
  return {{"lon_deg", a.place.lon_deg},
          {"lat_deg", a.place.lat_deg},
          {"elevation_m", value(a.elevation_m)},
          {"measured_m", std::isfinite(measured_m) ? json(measured_m) : json()},
          {"kind", kind != nullptr ? json(kind) : json()},
          {"datum", to_string(meta.datum)},
          {"radius_m", meta.datum.is_geometric()
                           ? value(mars::radius_at(meta.datum, mars::direction(a.place), a.elevation_m))
                           : json()},
          {"slope_deg", value(a.slope_deg)},
          {"aspect_deg", value(a.aspect_deg)},
          {"level", a.level},
          {"post_spacing_m", a.spacing_m},
          {"source", source != nullptr ? json(source->name) : json()},
          {"source_spacing_m", source != nullptr ? json(source->resolution_m) : json()},
          {"tile_sources", std::move(tile_sources)},
          {"tile_error_m", value(a.geometric_error_m)},
          {"resampling_max_m", has_error ? json(a.resampling.max_m) : json()},
          {"resampling_rms_m", has_error ? json(a.resampling.rms_m) : json()},
          {"resampling_posts", a.resampling.posts},
          {"resampling_scope", has_error ? json(a.resampling_of_level ? "level" : "tile") : json()},
          {"planet_resampling_max_m", meta.resampling.max_m},
          {"illustration", source != nullptr && source->illustration}};
}

std::string fixed(double x, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, x);
  return text;
}

void print_csv(const paging::PlaceAnswer& a, const paging::PlanetMeta& meta, double measured_m) {
  const auto number = [&](double x, int digits) { return a.nodata ? "" : fixed(x, digits); };
  const mars::SourceInfo* source = source_of(a, meta);
  const auto error = [&](double x) { return a.resampling.posts > 0 ? fixed(x, 3) : ""; };
  const char* kind = kind_of(a, meta);
  std::printf("%s,%s,%s,%s,%s,%d,%.2f,%s,%s,%s,%s,%s,%s,%s,%s", base::format_number(a.place.lon_deg).c_str(),
              base::format_number(a.place.lat_deg).c_str(), number(a.elevation_m, 3).c_str(),
              number(a.slope_deg, 3).c_str(), number(a.aspect_deg, 2).c_str(), a.level, a.spacing_m,
              source != nullptr ? csv_field(source->name).c_str() : "", number(a.geometric_error_m, 3).c_str(),
              csv_field(to_string(meta.datum)).c_str(),
              source != nullptr ? fixed(source->resolution_m, 2).c_str() : "",
              error(a.resampling.max_m).c_str(), error(a.resampling.rms_m).c_str(), kind != nullptr ? kind : "",
              std::isfinite(measured_m) ? fixed(measured_m, 3).c_str() : "");
}

// The highest object at a place.
struct ObjectAnswer {
  std::string name;  // of the object, or of its model
  double top_m = 0;  // above the planet's sphere
};

struct QueryArguments {
  std::vector<std::string> planet_and_places;
  std::string scene;
  std::string latitude;
  bool fail_on_nodata = false;
};

// Returns the highest object at each place; nullopt where there is none.
std::vector<std::optional<ObjectAnswer>> objects_at(const std::string& file,
                                                    const std::vector<mars::LonLat>& places,
                                                    const paging::Surface& surface, bool quiet) {
  SceneLibrary library(surface);
  const PlacedScene placed = library.scene(file, 1, 0);
  if (!quiet) {
    for (const std::string& note : library.take_notes()) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
  }
  const objects::Scene& scene = *placed.scene;
  std::vector<std::optional<ObjectAnswer>> out(places.size());
  if (scene.is_empty()) return out;
  const objects::SceneBall all = scene.ball();
  const double from_m = glm::length(all.centre_m) + all.radius_m;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const glm::dvec3 up = mars::direction(places[n]);
    const auto top = objects::first_object(scene, {from_m * up, -up}, from_m);
    if (!top) continue;
    out[n] = ObjectAnswer{object_name(scene, top->instance), from_m - top->range_m - surface.planet_radius_m()};
  }
  return out;
}

constexpr const char* kColumns =
    "lon_deg,lat_deg,elevation_m,slope_deg,aspect_deg,level,post_spacing_m,source,tile_error_m,datum,"
    "source_spacing_m,resampling_max_m,resampling_rms_m,kind,measured_m";

// Returns the names of a table's further columns as the answer has them: a name that the answer uses itself gets
// the prefix input_.
std::vector<std::string> answer_names(const std::vector<std::string>& columns) {
  std::vector<std::string> names = columns;
  for (std::string& name : names)
    if (("," + std::string(kColumns) + ",").find("," + name + ",") != std::string::npos) name = "input_" + name;
  return names;
}

using Objects = std::optional<std::vector<std::optional<ObjectAnswer>>>;

void print_json_answers(const std::vector<paging::PlaceAnswer>& answers, const PlaceTable& table,
                        const paging::PlanetMeta& meta, const Objects& things) {
  const std::vector<double> measured_m = measured_parts_m(answers, meta);
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t n = 0; n < answers.size(); ++n) {
    nlohmann::json& answer = list.emplace_back(to_json(answers[n], meta, measured_m[n]));
    if (things) {
      const std::optional<ObjectAnswer>& object = (*things)[n];
      answer["object"] = object ? nlohmann::json(object->name) : nlohmann::json();
      answer["object_top_m"] = object ? nlohmann::json(object->top_m) : nlohmann::json();
    }
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      answer["input"][table.columns[c]] = table.cells[n][c];
  }
  print_json(list);
}

void print_csv_answers(const std::vector<paging::PlaceAnswer>& answers, const PlaceTable& table,
                       const paging::PlanetMeta& meta, const Objects& things) {
  const std::vector<double> measured_m = measured_parts_m(answers, meta);
  std::fputs(kColumns, stdout);
  if (things) std::fputs(",object,object_top_m", stdout);
  for (const std::string& name : answer_names(table.columns)) std::printf(",%s", csv_field(name).c_str());
  std::puts("");
  for (std::size_t n = 0; n < answers.size(); ++n) {
    print_csv(answers[n], meta, measured_m[n]);
    if (things) {
      const std::optional<ObjectAnswer>& object = (*things)[n];
      std::printf(",%s,%s", object ? csv_field(object->name).c_str() : "",
                  object ? fixed(object->top_m, 3).c_str() : "");
    }
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      std::printf(",%s", csv_field(table.cells[n][c]).c_str());
    std::puts("");
  }
}

void query(const QueryArguments& arguments, const Common& common) {
  PlanetAndPlaces request = split_places(arguments.planet_and_places);
  PlaceTable table;
  table.places = std::move(request.places);
  if (table.places.empty()) table = read_places(std::cin);
  const auto planet = open_planet(request.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  make_planetocentric(table.places, arguments.latitude, meta, common.quiet);
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
  std::vector<paging::PlaceAnswer> answers(places.size());
  constexpr std::size_t kChunk = 2048;
  base::ThreadPool pool(common.threads);
  pool.run((order.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(order.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i)
      answers[order[i]] = paging::query(surface, places[order[i]]);
  });

  Objects things;
  if (!arguments.scene.empty()) things = objects_at(arguments.scene, places, surface, common.quiet);
  if (common.json) {
    print_json_answers(answers, table, meta, things);
  } else {
    print_csv_answers(answers, table, meta, things);
  }
  const auto without = std::count_if(answers.begin(), answers.end(), [](const auto& a) { return a.nodata; });
  if (arguments.fail_on_nodata && without > 0)
    throw std::runtime_error(std::to_string(without) + " of " + std::to_string(answers.size()) +
                             " places have no data");
}

}  // namespace

void add_query(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<QueryArguments>();
  CLI::App* command = add_command(
      program, "query", "Print elevation, slope, level (from 0), source and error at places", common, true);
  command->add_option(
      "PLANET_AND_PLACES", arguments->planet_and_places,
      "[PLANET] LON,LAT... (degrees east, north, or as 4.6S,222.6W); without places, they are read "
      "from stdin, one a line or as a table with columns lon and lat");
  add_latitude_option(*command, arguments->latitude);
  command->add_option(
      "--with-objects", arguments->scene,
      "Scene file: answers name the highest object at a place, and the height of its top above the sphere");
  command->add_flag("--fail-on-nodata", arguments->fail_on_nodata,
                    "Exit with status 1 after the answers if a place has no data");
  add_examples(*command, {{"two places, longitude first", "vpe query mars.vpe -59.2,-13.7 226.875,17.375"},
                          {"a place as on maps", "vpe query mars.vpe 13.7S,59.2W"},
                          {"a table of places with a header that names lon and lat",
                           "vpe query mars.vpe --json < places.csv"}});
  command->callback([arguments, &common] { query(*arguments, common); });
}

}  // namespace vpe::app
