#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include "mars/geodesy/kml_way.h"
#include "mars/geodesy/place_text.h"
#include "paging/surface/surface.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/app/places/places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/explore/traverse/stamped_way.h"
#include "vpe/explore/traverse/tour.h"
#include "vpe/explore/traverse/traverse.h"

namespace vpe::app {

namespace {

namespace fs = std::filesystem;
using explore::TraverseBy;

struct TraverseArguments {
  std::string file;
  std::string planet;
  std::string output;
  std::string by = "walk";
  std::string latitude;
  std::optional<double> speed_m_s;
  std::optional<double> camera_height_m;
  std::optional<double> step_m;
  double limit_deg = explore::VehicleOptions{}.steepest_deg;
  int way = 0;  // from 1; 0: all
  std::string layer;
  std::optional<double> time_scale;
  bool fail_on_slope = false;
};

constexpr double kTourSpeed_m_s = 1000;

std::string count_of(const mars::KmlWay& way) {
  return std::string(to_string(way.kind)) + " of " + std::to_string(way.points.size()) + " points";
}

// Returns the points of the chosen way, or of all ways if they are of one kind.
std::vector<mars::KmlPoint> points_of(const std::vector<mars::KmlWay>& ways, int chosen,
                                      const std::string& file) {
  if (chosen > 0) {
    if (static_cast<std::size_t>(chosen) > ways.size())
      throw UsageError("--way " + std::to_string(chosen) + ": " + file + " has " + std::to_string(ways.size()) +
                       (ways.size() == 1 ? " way" : " ways"));
    return ways[static_cast<std::size_t>(chosen) - 1].points;
  }
  std::vector<mars::KmlPoint> all;
  for (const mars::KmlWay& way : ways) {
    if (way.kind != ways.front().kind) {
      std::string list;
      for (std::size_t n = 0; n < ways.size(); ++n)
        list += (n > 0 ? ", " : "") + std::to_string(n + 1) + ": " + count_of(ways[n]);
      throw UsageError(file + " has ways of several kinds; choose one with --way (" + list + ")");
    }
    all.insert(all.end(), way.points.begin(), way.points.end());
  }
  return all;
}

bool ends_as(const std::string& file, std::initializer_list<std::string_view> extensions) {
  std::string end = fs::path(file).extension().string();
  for (char& c : end) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::ranges::find(extensions, end) != extensions.end();
}

bool is_kml(const std::string& file) { return ends_as(file, {".kml"}); }

// Tables and KML have readers of their own.
bool is_vector(const std::string& file) {
  return ends_as(file, {".gpx", ".geojson", ".json", ".gpkg", ".shp", ".kmz"});
}

std::vector<mars::KmlPoint> read_kml(const TraverseArguments& arguments) {
  const std::vector<std::uint8_t> bytes = base::read_file(arguments.file, mars::kLargestKml_bytes);
  const std::string text(bytes.begin(), bytes.end());
  return points_of(mars::parse_kml(text, arguments.file), arguments.way, arguments.file);
}

std::vector<mars::KmlPoint> read_table(const TraverseArguments& arguments) {
  if (arguments.way > 0) throw UsageError("--way is for KML and vector files; a table has one way");
  PlaceTable table;
  if (arguments.file == "-") {
    table = read_places(std::cin);
  } else {
    constexpr std::uintmax_t kLargestTable_bytes = std::uintmax_t{256} << 20;
    const std::vector<std::uint8_t> bytes = base::read_file(arguments.file, kLargestTable_bytes);
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    table = read_places(in, arguments.file);
  }
  std::vector<mars::KmlPoint> points(table.places.size());
  for (std::size_t n = 0; n < points.size(); ++n) points[n].place = table.places[n];
  return points;
}

// Returns the points of the chosen way of a vector file, or of all its ways one after the other.
std::vector<explore::WayPoint> read_vector(const TraverseArguments& arguments, double planet_radius_m) {
  const std::vector<explore::FileWay> ways =
      explore::read_ways(arguments.file, arguments.layer, planet_radius_m);
  if (static_cast<std::size_t>(arguments.way) > ways.size())
    throw UsageError("--way " + std::to_string(arguments.way) + ": " + arguments.file + " has " +
                     std::to_string(ways.size()) + (ways.size() == 1 ? " way" : " ways"));
  if (arguments.way > 0) return ways[static_cast<std::size_t>(arguments.way) - 1].points;
  std::vector<explore::WayPoint> all;
  for (const explore::FileWay& way : ways) all.insert(all.end(), way.points.begin(), way.points.end());
  return all;
}

// Queries the surface. Tiles that cannot be read are errors.
explore::TerrainQuery terrain_of(const paging::Surface& surface) {
  explore::TerrainQuery ground = explore::ball(surface.planet_radius_m());
  ground.height_m = [&surface](const glm::dvec3& direction) { return surface.at(direction, 1).height_m; };
  return ground;
}

std::string duration_text(double time_s) {
  const auto minutes = static_cast<long long>(std::llround(time_s / 60));
  if (minutes < 2) return base::format_rounded(time_s, 1) + " s";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

void report(const explore::Traverse& traverse, const TraverseArguments& arguments, const Common& common) {
  if (common.json) {
    print_json(
        {{"flight", arguments.output},
         {"by", arguments.by},
         {"poses", traverse.flight.waypoints.size()},
         {"length_m", traverse.length_m},
         {"duration_s", traverse.duration_s},
         {"steepest_deg", traverse.steepest_deg},
         {"steepest_lon_deg", traverse.steepest_at.lon_deg},
         {"steepest_lat_deg", traverse.steepest_at.lat_deg},
         {"slope_limit_deg", traverse.limit_deg > 0 ? nlohmann::json(traverse.limit_deg) : nlohmann::json()},
         {"poses_too_steep", traverse.too_steep}});
  } else if (!common.quiet) {
    std::fprintf(
        stderr, "vpe: %s: %zu poses, %s km, %s; steepest %s degrees at %s,%s\n", arguments.output.c_str(),
        traverse.flight.waypoints.size(), base::format_rounded(traverse.length_m / 1000, 3).c_str(),
        duration_text(traverse.duration_s).c_str(), base::format_rounded(traverse.steepest_deg, 1).c_str(),
        base::format_rounded(traverse.steepest_at.lon_deg, 6).c_str(),
        base::format_rounded(traverse.steepest_at.lat_deg, 6).c_str());
  }
  if (traverse.too_steep == 0) return;
  const std::string text = std::to_string(traverse.too_steep) + " of " +
                           std::to_string(traverse.flight.waypoints.size()) + " poses are on slopes beyond " +
                           base::format_number(traverse.limit_deg) + " degrees";
  if (arguments.fail_on_slope) throw std::runtime_error(text);
  if (!common.quiet) std::fprintf(stderr, "vpe: warning: %s\n", text.c_str());
}

explore::Traverse tour_of(const std::vector<mars::KmlPoint>& points, const TraverseArguments& arguments,
                          const explore::TerrainQuery& ground) {
  explore::Traverse tour;
  tour.flight = explore::make_tour(points, arguments.speed_m_s.value_or(kTourSpeed_m_s), ground);
  tour.duration_s = scripts::duration_s(tour.flight);
  for (std::size_t n = 1; n < points.size(); ++n)
    tour.length_m += mars::distance_rad(points[n - 1].place, points[n].place) * ground.radius_m;
  return tour;
}

explore::TraverseOptions options_of(const TraverseArguments& arguments) {
  explore::TraverseOptions options;
  options.by = arguments.by == "walk"    ? TraverseBy::kWalk
               : arguments.by == "drive" ? TraverseBy::kDrive
                                         : TraverseBy::kHeight;
  options.speed_m_s = arguments.speed_m_s;
  options.camera_height_m = arguments.camera_height_m;
  options.step_m = arguments.step_m;
  options.vehicle.steepest_deg = arguments.limit_deg;
  if (arguments.by == "drive" && arguments.camera_height_m) options.vehicle.mast_m = *arguments.camera_height_m;
  return options;
}

explore::Traverse vector_traverse(const TraverseArguments& arguments, const explore::TerrainQuery& ground) {
  const std::vector<explore::WayPoint> points = read_vector(arguments, ground.radius_m);
  explore::StampOptions stamps;
  stamps.keeps_times = !arguments.speed_m_s;
  stamps.scale = arguments.time_scale.value_or(1);
  if (arguments.time_scale && !explore::has_times(points))
    throw UsageError("--time-scale: the points of " + arguments.file + " have no times; give --speed");
  return explore::make_stamped_traverse(points, options_of(arguments), stamps, ground);
}

void check_vector_options(const TraverseArguments& arguments) {
  if (is_vector(arguments.file)) {
    if (!arguments.latitude.empty())
      throw UsageError("--latitude is for tables and KML; " + arguments.file + " names its own coordinates");
    if (arguments.time_scale && arguments.speed_m_s)
      throw UsageError("--time-scale and --speed: leave one out");
    return;
  }
  if (!arguments.layer.empty() || arguments.time_scale)
    throw UsageError("--layer and --time-scale are for GPX, GeoJSON, GeoPackage, Shapefile and KMZ");
}

void write_traverse(const explore::Traverse& traverse, const TraverseArguments& arguments,
                    const Common& common) {
  std::string text = scripts::to_text(traverse.flight);
  const std::string head = scripts::version_line(scripts::version_of(traverse.flight));
  text.insert(head.size(), "# traverse of vpe: " + on_one_line(arguments.file) + ", by " + arguments.by + "\n");
  base::write_file(arguments.output, text);
  report(traverse, arguments, common);
}

void run_vector_traverse(const TraverseArguments& arguments, const Common& common) {
  const auto planet = open_planet(arguments.planet, common);
  note_illustration(planet->meta(), common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  explore::Traverse traverse;
  try {
    traverse = vector_traverse(arguments, terrain_of(surface));
  } catch (const std::invalid_argument& e) {
    throw UsageError(arguments.file + ": " + e.what());
  }
  write_traverse(traverse, arguments, common);
}

void run_traverse(const TraverseArguments& arguments, const Common& common) {
  check_outputs({{"-o", arguments.output, FileKind::kTraverse}},
                {arguments.file == "-" ? "" : arguments.file, arguments.planet});
  check_vector_options(arguments);
  if (is_vector(arguments.file)) {
    run_vector_traverse(arguments, common);
    return;
  }
  std::vector<mars::KmlPoint> points = is_kml(arguments.file) ? read_kml(arguments) : read_table(arguments);
  const auto planet = open_planet(arguments.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  std::vector<mars::LonLat> places(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) places[n] = points[n].place;
  make_planetocentric(places, arguments.latitude, meta, common.quiet);
  for (std::size_t n = 0; n < points.size(); ++n) points[n].place = places[n];
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  const explore::TerrainQuery ground = terrain_of(surface);
  const bool is_tour = arguments.by == "height" && !points.empty() &&
                       std::ranges::all_of(points, [](const mars::KmlPoint& p) { return p.view.has_value(); });
  if (is_tour && (arguments.camera_height_m || arguments.step_m))
    throw UsageError(
        "--eye and --step do not apply to a tour, which has its own views; leave them out, or use --by walk");
  explore::Traverse traverse;
  try {
    traverse = is_tour ? tour_of(points, arguments, ground)
                       : explore::make_traverse(places, options_of(arguments), ground);
  } catch (const std::invalid_argument& e) {
    throw UsageError(arguments.file + ": " + e.what());
  }
  write_traverse(traverse, arguments, common);
}

}  // namespace

void add_traverse(CLI::App& program, Common& common) {
  using O = explore::TraverseOptions;
  auto arguments = std::make_shared<TraverseArguments>();
  CLI::App* command =
      add_command(program, "traverse",
                  "Make a flight of a walker, a rover or a camera along a way over the ground", common, true);
  command
      ->add_option(
          "FILE", arguments->file,
          "Way: lines, tracks or points of a GPX, GeoJSON, GeoPackage, Shapefile or KMZ file; KML (LineString, "
          "gx:Track, gx:Tour); or a table of places as for 'vpe query', - = stdin")
      ->required();
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("-o,--output", arguments->output, "Flight to write, for 'vpe fly' and 'vpe explore'")
      ->required();
  command
      ->add_option(
          "--by", arguments->by,
          "walk = eyes of a walker; drive = camera of a rover, with its roll and pitch; height = camera at a "
          "height, or the views of a tour")
      ->check(CLI::IsMember({"walk", "drive", "height"}))
      ->capture_default_str();
  command
      ->add_option("--speed", arguments->speed_m_s,
                   "Metres a second (default: times of a vector file's points, where it has them; walk "
                   "1.4 on level ground, drive 2, height 50, views of a tour 1000)")
      ->check(number_within(O::kMinSpeed_m_s, O::kMaxSpeed_m_s));
  command
      ->add_option("--eye", arguments->camera_height_m,
                   "Height of the camera above the ground, metres (default: walk 1.7, drive 2, height 100)")
      ->check(number_within(O::kMinEye_m, O::kMaxEye_m));
  command
      ->add_option(
          "--step", arguments->step_m,
          "Largest distance between poses, metres (default: walk 2, drive 1, height a quarter of --eye; more on "
          "ways of many poses)")
      ->check(number_within(O::kMinStep_m, O::kMaxStep_m));
  command->add_option("--slope-limit", arguments->limit_deg, "Slope beyond which a rover is reported, degrees")
      ->check(number_within(1, explore::VehicleOptions::kMaxSteepest_deg))
      ->capture_default_str();
  command->add_flag("--fail-on-slope", arguments->fail_on_slope,
                    "Exit with status 1, after writing, if a pose is on a slope beyond the limit");
  command
      ->add_option("--way", arguments->way, "Number of the way in a KML or vector file (default: all, joined)")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--layer", arguments->layer, "Layer of a vector file (default: all)");
  command
      ->add_option("--time-scale", arguments->time_scale,
                   "How many times faster the flight is than the times of a vector file's points")
      ->check(number_within(explore::StampOptions::kLeastScale, explore::StampOptions::kMostScale));
  add_latitude_option(*command, arguments->latitude);
  add_examples(*command,
               {{"a walk along the places of a table", "vpe traverse places.csv mars.vpe -o walk.flight"},
                {"a rover's way, and a film of it",
                 "vpe traverse rover.kml gale.vpe --by drive -o rover.flight && vpe fly rover.flight gale.vpe "
                 "-o rover.mp4"},
                {"a track with its times, ten times as fast",
                 "vpe traverse track.gpx mars.vpe --by drive --time-scale 10 -o track.flight"},
                {"the views of a tour", "vpe traverse tour.kml mars.vpe --by height -o tour.flight"}});
  command->callback([arguments, &common] { run_traverse(*arguments, common); });
}

}  // namespace vpe::app
