#include "vpe/app/planet/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/planet/planet_json.h"

namespace vpe::app {

namespace {

void info(const std::string& argument, const Common& common) {
  const auto planet = open_planet(argument, common);
  const paging::PlanetMeta& m = planet->meta();
  if (common.json) {
    nlohmann::json json = planet_json(m);
    json["path"] = planet->path();
    json["raster"] = is_raster_argument(argument) ? nlohmann::json(argument) : nlohmann::json();
    print_json(json);
    return;
  }
  const auto line = [](const char* what, const std::string& value) {
    std::printf("%-18s %s\n", what, on_one_line(value).c_str());
  };
  const auto number = [](double x, const char* unit) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6g %s", x, unit);
    return std::string(text);
  };
  if (is_raster_argument(argument)) line("raster", argument);
  line(is_raster_argument(argument) ? "its planet file" : "file", planet->path());
  if (m.illustration) line("NOTE", "an illustration: its numbers are not data");
  line("body", m.body + ", sphere of radius " + number(m.radius_m, "m"));
  line("vertical datum", paging::describe_datum(m));
  line("heights", number(m.lowest_radius_m - m.radius_m, "m") + " .. " +
                      number(m.highest_radius_m - m.radius_m, "m") + ", stored in steps of " +
                      number(m.quantum_m, "m"));
  line("tiles", std::to_string(m.tiles) + " (" + std::to_string(m.leaf_tiles) + " finest) of " +
                    std::to_string(m.tile.intervals()) + " intervals, levels 0 .. " +
                    std::to_string(m.finest_level));
  line("finest posts", number(lod::post_spacing_m(m.finest_level, m.tile.intervals(), m.radius_m), "m"));
  line("image",
       m.image_tiles == 0
           ? "none"
           : std::to_string(m.image_tiles) + " tiles, finest texels " +
                 number(lod::post_spacing_m(m.finest_image_level, paging::kImageIntervals, m.radius_m), "m"));
  line("resampling error", "RMS " + number(m.resampling.rms_m, "m") + ", maximum " +
                               number(m.resampling.max_m, "m") + " over " + std::to_string(m.resampling.posts) +
                               " source posts");
  for (const mars::SourceInfo& s : m.sources) {
    line("elevation from", s.name + " (" + number(s.resolution_m, "m") + " posts, datum " + to_string(s.datum) +
                               ")" + (s.treatment.empty() ? "" : "; " + s.treatment));
  }
  for (const mars::SourceInfo& s : m.image_sources)
    line("image from", s.name + " (" + number(s.resolution_m, "m") + " pixels)");
  line("built by", "vpe " + m.program + ", identity " + m.identity);
}

}  // namespace

void add_info(CLI::App& program, Common& common) {
  auto planet = std::make_shared<std::string>();
  CLI::App* command = add_command(
      program, "info", "Describe a planet file: body, datum, levels, sources, resampling error", common, true);
  command->add_option("PLANET", *planet, "Planet file or DEM (default: the embedded Mars)");
  add_examples(*command, {{"what a planet file holds", "vpe info mars.vpe"},
                          {"all figures, with every level, for a program", "vpe info mars.vpe --json"}});
  command->callback([planet, &common] { info(*planet, common); });
}

}  // namespace vpe::app
