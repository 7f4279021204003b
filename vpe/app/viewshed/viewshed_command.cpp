#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/viewshed/commands.h"
#include "vpe/app/viewshed/viewshed_map.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr double kMostViewHeight_m = 1e9;
constexpr double kMostReach_m = 1e12;
constexpr double kLeastViewSpacing_m = 1e-3;
constexpr std::size_t kMostObservers = 254;  // bytes count them, and 255 is nodata

struct ViewshedArguments {
  std::string planet;
  std::vector<std::string> at;
  double from_height_m = 2;
  double to_height_m = 0;
  double reach_m = 0;
  double spacing_m = 0;
  bool needed = false;
  std::string crs;
  std::string latitude;
  std::string output;
};

// Parses LON,LAT,HEIGHT, a place in any notation, or a name.
Observer parse_observer(const std::string& text, const ViewshedArguments& a, const paging::PlanetMeta& meta,
                        bool quiet) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 3)
    return {place_on(given_place("--at", text), "--at", a.latitude, meta, quiet), a.from_height_m};
  if (!(std::abs((*numbers)[2]) <= kMostViewHeight_m) || (*numbers)[2] < 0)
    throw UsageError("--at '" + text + "': the height must be 0 to 1e9 metres above the ground");
  const std::string place = text.substr(0, text.rfind(','));
  return {planetocentric(parse_place(place, "--at "), a.latitude, meta, quiet), (*numbers)[2]};
}

void print_viewshed(const nlohmann::json& view, const std::string& output) {
  const auto number = [](const nlohmann::json& value) {
    return value.is_null() ? std::string("unknown") : base::format_significant(value.get<double>(), 4);
  };
  const auto percent = [&](const char* key) {
    return base::format_significant(100 * view[key].get<double>(), 3);
  };
  std::printf("map:         %s, %d x %d pixels of %s m\n", on_one_line(output).c_str(),
              view["columns"].get<int>(), view["rows"].get<int>(), number(view["spacing_m"]).c_str());
  for (const nlohmann::json& observer : view["observers"]) {
    std::printf("observer:    %s,%s, %s m above the ground at elevation %s m\n",
                base::format_number(observer["lon_deg"].get<double>()).c_str(),
                base::format_number(observer["lat_deg"].get<double>()).c_str(),
                number(observer["height_m"]).c_str(),
                base::format_significant(observer["elevation_m"].get<double>(), 6).c_str());
  }
  std::printf("seen:        %s %% of the known pixels\n", percent("seen_share").c_str());
  std::printf("known:       %s %% of the pixels\n", percent("known_share").c_str());
  std::printf("crs:         %s\n", on_one_line(view["crs"].get<std::string>()).c_str());
  std::printf("datum:       %s\n", on_one_line(view["datum"].get<std::string>()).c_str());
  std::printf("resolution:  posts %s to %s m apart\n", number(view["post_spacing_m"]).c_str(),
              number(view["coarsest_post_spacing_m"]).c_str());
  std::printf("error:       at most %s m against the posts of the sources\n",
              number(view["resampling_max_m"]).c_str());
  for (const nlohmann::json& source : view["sources"])
    std::printf("source:      %s\n", on_one_line(source.get<std::string>()).c_str());
  std::printf("nodata:      %s %% of the posts\nsynthetic:   %s %% of the posts\n",
              percent("nodata_share").c_str(), percent("synthetic_share").c_str());
}

ViewshedRequest request_of(const ViewshedArguments& a, const paging::PlanetMeta& meta, bool quiet) {
  ViewshedRequest request;
  if (a.at.size() > kMostObservers)
    throw UsageError("--at: " + std::to_string(a.at.size()) + " observers; at most " +
                     std::to_string(kMostObservers) + " are possible");
  for (const std::string& text : a.at)
    request.observers.push_back(parse_observer(text, a, meta, quiet || !request.observers.empty()));
  request.target_height_m = a.to_height_m;
  request.reach_m = a.reach_m;
  request.spacing_m = a.spacing_m;
  request.needed = a.needed;
  const double quarter_m = meta.radius_m * std::numbers::pi / 2;
  if (request.reach_m > quarter_m)
    throw UsageError("--radius " + base::format_number(a.reach_m) +
                     ": no more than a quarter of the circumference, " +
                     base::format_significant(quarter_m, 6) + " m, is possible");
  return request;
}

ViewshedMap look(const paging::Surface& surface, const ViewshedRequest& request, const std::string& crs_text,
                 const Common& common) {
  const double radius_m = surface.planet_radius_m();
  const bool is_own_map = crs_text.empty() && request.observers.size() == 1;
  ViewshedMap all;
  all.crs = crs_text.empty() ? equidistant_crs(request.observers[0].place, radius_m) : crs_text;
  const mars::MapCrs crs(all.crs, radius_m);
  all.unit_m = crs.unit_m();
  all.grid = is_own_map ? grid_of_frame(frame_of_observer(request.observers[0].place, request, radius_m))
                        : grid_of_observers(crs, request, radius_m);
  ProgressLine progress(common.quiet);
  const auto observers = static_cast<double>(request.observers.size());
  double done = 0;
  if (!is_own_map) {
    all.value.assign(static_cast<std::size_t>(all.grid.columns) * static_cast<std::size_t>(all.grid.rows),
                     std::numeric_limits<float>::quiet_NaN());
  }
  const std::vector<glm::dvec2> places =
      is_own_map ? std::vector<glm::dvec2>() : map::places_of_rows(crs, all.grid, 0, all.grid.rows);
  for (const Observer& observer : request.observers) {
    ObserverMap seen = look_around(surface, observer, request, common.threads, [&](double share) {
      InterruptGuard::check();
      progress.show("looking", (done + share) / observers);
    });
    all.ground.add(seen.ground);
    all.elevations_m.push_back(seen.elevation_m);
    if (is_own_map) {
      all.value = std::move(seen.value);
    } else {
      add_observer(seen, request, places, all.value);
    }
    ++done;
  }
  return all;
}

void run_viewshed(const ViewshedArguments& a, const Common& common) {
  check_outputs({{"-o", a.output, FileKind::kMap}}, {a.planet});
  const auto planet = open_planet(a.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  ViewshedRequest request = request_of(a, meta, common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  if (request.spacing_m == 0) request.spacing_m = paging::query(surface, request.observers[0].place).spacing_m;
  const InterruptGuard guard;
  ViewshedMap all;
  try {
    all = look(surface, request, a.crs, common);
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("vpe viewshed: ") + e.what());
  }
  write_viewshed(a.output, all, request, meta);
  const nlohmann::json view = viewshed_json(all, request, meta);
  if (common.json) {
    print_json(view);
  } else {
    print_viewshed(view, a.output);
  }
}

}  // namespace

void add_viewshed(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ViewshedArguments>();
  CLI::App* command =
      add_command(program, "viewshed", "Map what observers see of the ground around them", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command
      ->add_option(
          "--at", arguments->at,
          "LON,LAT of an observer, degrees, or LON,LAT,HEIGHT of the eye above the ground, or the name of a "
          "place; once for each")
      ->allow_extra_args(false)
      ->required();
  command->add_option("--from-height", arguments->from_height_m, "Height of eyes above the ground, metres")
      ->check(number_within(0, kMostViewHeight_m))
      ->capture_default_str();
  command->add_option("--to-height", arguments->to_height_m, "Height of the target above the ground, metres")
      ->check(number_within(0, kMostViewHeight_m))
      ->capture_default_str();
  command->add_option("--radius", arguments->reach_m, "How far observers look, along the ground, metres")
      ->required()
      ->check(number_within(kLeastViewSpacing_m, kMostReach_m));
  command
      ->add_option("--spacing", arguments->spacing_m,
                   "Metres between posts (default: those of the planet at the first observer)")
      ->check(number_within(kLeastViewSpacing_m, kMostReach_m));
  command
      ->add_flag("--needed", arguments->needed,
                 "Write how high above the ground a target must be to be seen, instead of who sees it")
      ->excludes("--to-height");
  command->add_option(
      "--crs", arguments->crs,
      "Coordinate system of the map: IAU_2015:CODE, a PROJ string, WKT (default: azimuthal equidistant "
      "around the first observer)");
  add_latitude_option(*command, arguments->latitude);
  command->add_option("-o,--output", arguments->output, "Cloud-optimised GeoTIFF to write (.tif)")->required();
  add_examples(
      *command,
      {{"what a rover's mast sees within 15 km",
        "vpe viewshed gale.vpe --at 137.4417,-4.5895 --from-height 2 --radius 15000 --spacing 20 -o seen.tif"},
       {"how many of two antennas reach a rover of 2 m",
        "vpe viewshed gale.vpe --at 137.35,-4.65,10 --at 137.48,-4.72,10 --to-height 2 --radius 20000 "
        "--spacing 50 --crs IAU_2015:49910 -o antennas.tif"},
       {"how high a mast must be to be seen",
        "vpe viewshed gale.vpe --at 137.4417,-4.5895 --radius 15000 --spacing 20 --needed -o masts.tif"}});
  command->callback([arguments, &common] { run_viewshed(*arguments, common); });
}

}  // namespace vpe::app
