#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "paging/planet/planet_look.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/map/box_option.h"
#include "vpe/app/map/commands.h"
#include "vpe/app/map/map_maker.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/planet/shard_option.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/image_layers.h"

namespace vpe::app {

namespace {

constexpr double kLeastSpacing_m = 1e-3;
constexpr double kMostSpacing_m = 1e7;

struct MapArguments {
  std::string planet;
  std::string box;
  std::string crs;
  double spacing_m = 0;
  std::string bands = "elevation";
  std::string shade;
  std::string sun;
  std::string over = "sol";
  std::string image_layers;
  std::string part;
  std::string output;
};

void print_map(const nlohmann::json& map, const std::string& output) {
  const auto number = [](const nlohmann::json& value) {
    return value.is_null() ? std::string("unknown") : base::format_significant(value.get<double>(), 4);
  };
  const auto percent = [&](const char* key) {
    return map[key].is_null() ? std::string("-") : base::format_significant(100 * map[key].get<double>(), 3);
  };
  std::printf("map:         %s, %d x %d pixels of %s m\n", on_one_line(output).c_str(),
              map["columns"].get<int>(), map["rows"].get<int>(), number(map["spacing_m"]).c_str());
  std::string bands;
  for (const nlohmann::json& band : map["bands"])
    bands += (bands.empty() ? "" : ", ") + band["name"].get<std::string>();
  std::printf("bands:       %s\n", bands.c_str());
  std::printf("crs:         %s\n", on_one_line(map["crs"].get<std::string>()).c_str());
  std::printf("datum:       %s\n", on_one_line(map["datum"].get<std::string>()).c_str());
  std::printf("resolution:  posts %s to %s m apart\n", number(map["post_spacing_m"]).c_str(),
              number(map["coarsest_post_spacing_m"]).c_str());
  std::printf("error:       at most %s m against the posts of the sources\n",
              number(map["resampling_max_m"]).c_str());
  for (const nlohmann::json& source : map["sources"])
    std::printf("source:      %s\n", on_one_line(source.get<std::string>()).c_str());
  std::printf("nodata:      %s %% of the pixels\nsynthetic:   %s %% of the pixels\n",
              percent("nodata_share").c_str(), percent("synthetic_share").c_str());
}

std::shared_ptr<const paging::PlanetFile> with_image_layers(
    const std::shared_ptr<const paging::PlanetFile>& planet, const std::string& layers, MapRequest& request) {
  if (const std::string problem = core::image_layers_problem(layers); !problem.empty())
    throw UsageError("--image-layers '" + layers + "': " + problem);
  if (std::ranges::find(request.bands, map::MapBand::colour) == request.bands.end())
    throw UsageError("--image-layers: of the bands only colour shows imagery; add it to --bands");
  request.image_layers = layers;
  return paging::with_layers_of(planet, layers);
}

void run_map(const MapArguments& a, const Common& common) {
  MapRequest request;
  request.box = parse_box(a.box);
  try {
    request.bands = map::parse_bands(a.bands);
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("--bands: ") + e.what());
  }
  request.spacing_m = a.spacing_m;
  request.shade = a.shade;
  request.sun = a.sun;
  request.year = a.over == "year";
  const base::Shard shard = parse_shard(a.part);
  check_outputs({{"-o", a.output, FileKind::kMap}}, {a.planet});
  auto planet = open_planet(a.planet, common);
  if (!a.image_layers.empty()) planet = with_image_layers(planet, a.image_layers, request);
  require_planet_of_box(a.box, planet->meta());
  note_illustration(planet->meta(), common.quiet);
  request.crs = a.crs.empty() ? "+proj=eqc +R=" + base::format_number(planet->meta().radius_m) : a.crs;
  light_of(request, planet->meta());
  MapMaker maker(planet, request, a.output, common);
  const int missing = maker.make_strips(shard);
  if (!shard.is_all()) {
    if (!common.quiet) {
      std::fprintf(stderr, "vpe: part %lld of %lld is done; %d strips are missing; %s\n",
                   static_cast<long long>(shard.number), static_cast<long long>(shard.of), missing,
                   "the same command without --part makes those and joins all");
    }
    return;
  }
  const nlohmann::json map = maker.join();
  if (common.json) {
    print_json(map);
  } else {
    print_map(map, a.output);
  }
}

}  // namespace

void add_map(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command =
      add_command(program, "map", "Write heights, slopes, light and colours in map coordinates", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option(
      "--box", arguments->box,
      "WEST,SOUTH,EAST,NORTH, degrees, planetocentric, or the name of a feature (default: all of the planet)");
  command->add_option(
      "--crs", arguments->crs,
      "Coordinate system: IAU_2015:CODE, a PROJ string, WKT (default: equirectangular, true at the "
      "equator)");
  command->add_option("--spacing", arguments->spacing_m, "Metres between pixels; of degrees, along the equator")
      ->required()
      ->check(number_within(kLeastSpacing_m, kMostSpacing_m));
  command->add_option("--bands", arguments->bands, "Names with commas between them: " + map::band_names())
      ->capture_default_str();
  command->add_option(
      "--shade", arguments->shade,
      "AZIMUTH,ELEVATION of the light of band shade in the sky of each place (default: 315,45)");
  command->add_option(
      "--sun", arguments->sun,
      "Sun of bands sun and sun_hours: a date, a season (Ls90,15:00), or AZIMUTH,ELEVATION; season and "
      "angles hold at the middle of the box");
  command
      ->add_option("--over", arguments->over,
                   "Time of band sun_hours: the sol of the date, or the mean of 24 sols of a year")
      ->check(CLI::IsMember({"sol", "year"}))
      ->capture_default_str();
  command->add_option(
      "--image-layers", arguments->image_layers,
      "Image layers that the band colour shows, as the setting image.layers has them: "
      "NAME@OPACITY low= high= gamma=, with ';' between them (default: the imagery as the planet was built)");
  command->add_option(
      "--part", arguments->part,
      "K/N: make one of N parts of the strips; a run without --part makes what is missing and joins all");
  command->add_option("-o,--output", arguments->output, "Cloud-optimised GeoTIFF to write (.tif)")->required();
  add_examples(
      *command,
      {{"heights and slopes of Gale in the IAU's equirectangular system",
        "vpe map gale.vpe --box 137,-6,138.5,-4 --crs IAU_2015:49910 --spacing 50 --bands "
        "elevation,slope -o gale.tif"},
       {"the north polar cap in sunlight",
        "vpe map mars.vpe --box -180,75,180,90 --crs IAU_2015:49918 --spacing 1000 --bands sun,colour --sun "
        "Ls90,12:00 -o cap.tif"},
       {"hours of sun on a sol, all of Mars",
        "vpe map mars.vpe --spacing 14818 --bands sun_hours --sun 2026-11-27T12:00Z -o hours.tif"}});
  command->callback([arguments, &common] { run_map(*arguments, common); });
}

}  // namespace vpe::app
