// vpe measure.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/feature_output.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/measure/commands.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/explore/drawing/drawing_files.h"
#include "vpe/explore/drawing/drawing_measures.h"
#include "vpe/explore/drawing/sphere_polygon.h"
#include "vpe/explore/results/path_results.h"
#include "vpe/explore/results/polygon_results.h"

namespace vpe::app {

namespace {

using explore::Drawing;

struct MeasureArguments {
  std::vector<std::string> places;
  std::string file;
  std::string latitude;
  std::optional<double> level_m;
  std::string other;
  std::vector<double> limits_deg;
  std::string output;
};

std::vector<Drawing> read_polygons(const std::string& file, const paging::PlanetMeta& meta, bool quiet) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, explore::DrawingFileLimits::kMostBytes);
  const explore::ParsedGeoJson parsed =
      explore::parse_geojson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  if (!parsed.error.empty()) throw std::runtime_error(parsed.error);
  if (parsed.planet && std::abs(parsed.planet->radius_m - meta.radius_m) > 1e-3 * meta.radius_m)
    throw std::runtime_error(file + ": its places are on " + parsed.planet->body + ", with a radius of " +
                             base::format_number(parsed.planet->radius_m) + " m, and not on this planet");
  if (!quiet)
    for (const std::string& note : parsed.notes) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
  std::vector<Drawing> polygons;
  for (const Drawing& drawing : parsed.drawings)
    if (drawing.kind == explore::DrawingKind::kPolygon) polygons.push_back(drawing);
  if (polygons.empty()) throw std::runtime_error(file + ": there is no polygon in it");
  return polygons;
}

Drawing polygon_of(const std::vector<mars::LonLat>& places) {
  Drawing polygon;
  polygon.kind = explore::DrawingKind::kPolygon;
  for (const mars::LonLat& place : places)
    polygon.vertices.push_back({mars::normalize_lon_deg(place.lon_deg), place.lat_deg});
  if (const std::string problem = explore::problem_of(polygon); !problem.empty()) throw UsageError(problem);
  return polygon;
}

// Returns the ground of a planet file that volumes are measured against, or null if none is named.
std::shared_ptr<const paging::Surface> open_other(const std::string& name, const paging::PlanetFile& planet,
                                                  const Common& common) {
  if (name.empty()) return nullptr;
  const auto other = open_planet(name, common);
  try {
    (void)planet.compared_with(other);
  } catch (const paging::PlanetError& e) {
    throw std::runtime_error(std::string("--against ") + e.what());
  }
  return std::make_shared<const paging::Surface>(other, static_cast<std::size_t>(common.memory_mb) << 18);
}

void run_measure(const MeasureArguments& arguments, const Common& common) {
  const auto [planet_name, given] = split_places(arguments.places);
  if (!arguments.file.empty() && !given.empty())
    throw UsageError("--polygons names the outlines: leave out the places");
  if (arguments.file.empty() && given.size() < 3)
    throw UsageError("an outline needs at least three places LON,LAT in degrees, or --polygons FILE");
  check_feature_output(arguments.output, planet_name);
  const auto planet = open_planet(planet_name, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  const std::vector<mars::LonLat> places = places_on(given, arguments.latitude, meta, common.quiet);
  const std::vector<Drawing> polygons = arguments.file.empty()
                                            ? std::vector{polygon_of(places)}
                                            : read_polygons(arguments.file, meta, common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  const std::shared_ptr<const paging::Surface> other = open_other(arguments.other, *planet, common);
  const InterruptGuard guard;
  ProgressLine line(common.quiet);
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t n = 0; n < polygons.size(); ++n) {
    explore::MeasuredPolygon measured;
    measured.polygon = polygons[n];
    measured.options.level_m = arguments.level_m;
    measured.options.other = other;
    measured.options.slope_limits_deg = arguments.limits_deg;
    measured.options.progress = [&](double share) {
      InterruptGuard::check();
      line.show("measure", (static_cast<double>(n) + share) / static_cast<double>(polygons.size()));
    };
    const explore::SphereMeasures on_sphere = explore::sphere_measures(polygons[n], meta.radius_m);
    const std::string name = polygons[n].name.empty() ? "outline " + std::to_string(n + 1) : polygons[n].name;
    if (!on_sphere.no_area.empty()) throw std::runtime_error(name + ": " + on_sphere.no_area);
    measured.outline_m = on_sphere.length_m;
    try {
      measured.ground =
          *explore::ground_statistics(surface, explore::directions_of(polygons[n].vertices), measured.options);
      Drawing outline = polygons[n];
      outline.kind = explore::DrawingKind::kLine;
      outline.vertices.push_back(outline.vertices.front());
      measured.ground_outline_m = explore::ground_measures(surface, outline)->length_m;
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(name + ": " + e.what());
    }
    list.push_back(explore::polygon_json(measured, meta));
    if (!common.json) std::fputs(((n > 0 ? "\n" : "") + explore::polygon_text(measured, meta)).c_str(), stdout);
  }
  if (!arguments.output.empty())
    mars::write_features(
        arguments.output, explore::polygon_layer(list, polygons),
        explore::result_info("measure: ground within outlines, whose edges are great circles", meta));
  if (common.json) print_json(list);
}

}  // namespace

void add_measure(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<MeasureArguments>();
  CLI::App* command =
      add_command(program, "measure", "Measure ground within an outline: area, slopes, dip and strike, volumes",
                  common, true);
  command->add_option(
      "PLANET_AND_PLACES", arguments->places,
      "[PLANET] LON,LAT LON,LAT LON,LAT... (degrees east, north, or as 4.6S,222.6W, or names): the corners");
  command->add_option("--polygons", arguments->file,
                      "GeoJSON file; each polygon in it is measured, and other drawings are left out");
  add_latitude_option(*command, arguments->latitude);
  command
      ->add_option("--water-level", arguments->level_m,
                   "Also measure volumes above and below this elevation, metres")
      ->check(number_within(-1e7, 1e7));
  command->add_option("--against", arguments->other,
                      "Another planet file of the same body: also measure volumes above and below its ground");
  command
      ->add_option("--limit", arguments->limits_deg,
                   "Slopes in degrees, separated by commas: print how much of the ground is steeper")
      ->delimiter(',')
      ->check(number_within(0, 90));
  add_feature_output(*command, arguments->output, "Also write the outlines and what was measured as features");
  add_examples(*command, {{"a crater: its depth below the rim, its volume, its slopes",
                           "vpe measure mars.vpe 137.1,-4.9 137.9,-4.9 137.9,-4.3 137.1,-4.3 --limit 15,30"},
                          {"outlines that were drawn in the window, for programs",
                           "vpe measure mars.vpe --polygons units.geojson --json"},
                          {"the same for a geographic information system",
                           "vpe measure mars.vpe --polygons units.geojson -o measured.gpkg"},
                          {"the water of a lake with its level at -2500 m",
                           "vpe measure mars.vpe --polygons basin.geojson --water-level -2500"},
                          {"what has been dug and heaped up since an earlier planet file",
                           "vpe measure after.vpe --polygons site.geojson --against before.vpe"}});
  command->callback([arguments, &common] { run_measure(*arguments, common); });
}

}  // namespace vpe::app
