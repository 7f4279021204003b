// vpe find.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "mars/embedded/data_files.h"
#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/shell_word.h"
#include "vpe/app/commands.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"
#include "vpe/explore/places/landing_sites.h"
#include "vpe/explore/places/place_search.h"

namespace vpe::app {

namespace {

struct FindArguments {
  std::string name;
  std::string planet;
  std::string places;
  std::size_t most = 10;
};

struct FoundPlace {
  core::Place place;
  const explore::LandingSite* site = nullptr;  // that it is
  std::optional<paging::PlaceAnswer> ground;   // with a planet
};

nlohmann::json found_json(const FoundPlace& found, double radius_m) {
  const SightOfPlace sight = sight_of(found.place, radius_m);
  nlohmann::json out{
      {"name", found.place.name},
      {"lon_deg", found.place.lon_deg},
      {"lat_deg", found.place.lat_deg},
      {"diameter_m", found.place.diameter_m > 0 ? nlohmann::json(found.place.diameter_m) : nlohmann::json()},
      {"sight",
       {{"lon_deg", sight.lon_deg},
        {"lat_deg", sight.lat_deg},
        {"yaw_deg", sight.yaw_deg},
        {"pitch_deg", sight.pitch_deg},
        {"height_m", sight.height_m}}}};
  if (found.site != nullptr)
    out["landing"] = {
        {"mission", found.site->mission},
        {"date", found.site->landed},
        {"kind", found.site->kind},
        {"accuracy_m", found.site->accuracy_m ? nlohmann::json(*found.site->accuracy_m) : nlohmann::json()},
        {"source", found.site->source}};
  if (found.ground)
    out["elevation_m"] = found.ground->nodata ? nlohmann::json() : nlohmann::json(found.ground->elevation_m);
  return out;
}

std::string found_text(const FoundPlace& found) {
  const core::Place& place = found.place;
  std::string text = on_one_line(place.name) + ": " + base::format_fixed(place.lon_deg, 4) + "," +
                     base::format_fixed(place.lat_deg, 4);
  if (place.diameter_m > 0) text += ", " + base::format_significant(place.diameter_m / 1000, 4) + " km across";
  if (found.site != nullptr) text += ", " + on_one_line(explore::describe(*found.site));
  if (found.ground)
    text += found.ground->nodata ? ", nodata"
                                 : ", elevation " + base::format_fixed(found.ground->elevation_m, 1) + " m";
  return text + "\n";
}

// Returns the program's landing sites; none if their file is not there.
std::vector<explore::LandingSite> own_landing_sites() {
  const std::string file = mars::find_data_file(explore::kLandingsFile);
  return file.empty() ? std::vector<explore::LandingSite>() : explore::read_landing_sites(file);
}

void run_find(const FindArguments& arguments, const Common& common) {
  const explore::PlaceSearch search(read_places_of(arguments.places));
  const std::vector<const core::Place*> matches = search.find(arguments.name, arguments.most);
  if (matches.empty())
    throw std::runtime_error(
        "no place has a name like '" + arguments.name + "' in " +
        (arguments.places.empty() ? std::string("the program's list of Mars") : arguments.places));
  const std::vector<explore::LandingSite> sites =
      arguments.places.empty() ? own_landing_sites() : std::vector<explore::LandingSite>();
  std::shared_ptr<const paging::PlanetFile> planet;
  std::unique_ptr<const paging::Surface> surface;
  if (!arguments.planet.empty()) {
    planet = open_planet(arguments.planet, common);
    surface = std::make_unique<const paging::Surface>(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  }
  const double radius_m = planet ? planet->radius_m() : mars::kMarsRadius_m;
  nlohmann::json list = nlohmann::json::array();
  for (const core::Place* match : matches) {
    FoundPlace found{*match, nullptr, {}};
    const auto site = std::ranges::find(sites, *match, explore::to_place);
    if (site != sites.end()) found.site = &*site;
    if (surface) found.ground = paging::query(*surface, {match->lon_deg, match->lat_deg});
    if (common.json)
      list.push_back(found_json(found, radius_m));
    else
      std::fputs(found_text(found).c_str(), stdout);
  }
  if (common.json) {
    print_json(list);
    return;
  }
  const SightOfPlace sight = sight_of(*matches.front(), radius_m);
  const auto number = [](double value) { return base::format_fixed(value, 4); };
  std::printf("vpe render %s--pose %s,%s,%s,%s,0 --height %s -o view.png\n",
              arguments.planet.empty() ? "" : (shell_word(arguments.planet) + " ").c_str(),
              number(sight.lon_deg).c_str(), number(sight.lat_deg).c_str(), number(sight.yaw_deg).c_str(),
              number(sight.pitch_deg).c_str(), base::format_fixed(sight.height_m, 0).c_str());
}

}  // namespace

void add_find(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<FindArguments>();
  CLI::App* command = add_command(program, "find", "Find places by their names", common, true);
  command
      ->add_option("NAME", arguments->name,
                   "Name, its beginning or a part of it; case and accents do not count")
      ->required();
  command->add_option("PLANET", arguments->planet, "Planet file or DEM: also print elevations");
  command->add_option("--places", arguments->places,
                      "Gazetteer, as CSV: of the IAU as it is downloaded, or with the columns name, lon, lat "
                      "(default: the 1850 largest features of Mars, and the sites where spacecraft landed)");
  command->add_option("--limit", arguments->most, "Largest number of places")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_examples(*command, {{"a feature of Mars, and a command that draws it", "vpe find 'olympus mons'"},
                          {"a landing site, and how exactly it is known", "vpe find curiosity"},
                          {"with elevations, for programs", "vpe find gale mars.vpe --json"},
                          {"in a list of one's own", "vpe find ridge --places stations.csv"}});
  command->callback([arguments, &common] { run_find(*arguments, common); });
}

}  // namespace vpe::app
