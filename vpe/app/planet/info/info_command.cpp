#include "vpe/app/planet/info/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "paging/planet/planet_database.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/info/info_page.h"
#include "vpe/app/planet/info/planet_facts.h"
#include "vpe/app/planet/level_table.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/planet/planet_json.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace {

// Returns what a file with one part of a divided build states; nullopt for other arguments. Throws
// paging::PlanetError and paging::DatabaseError.
std::optional<paging::PlanetMeta> meta_of_part(const std::string& path) {
  if (!paging::is_planet_database(path)) return std::nullopt;
  const auto rows = paging::read_meta_rows(paging::open_planet_database(path));
  if (!rows.contains("part")) return std::nullopt;
  return paging::from_rows(rows, path);
}

void print_line(const char* what, const std::string& value) {
  std::printf("%-18s %s\n", what, on_one_line(value).c_str());
}

void info(const std::string& argument, const std::string& html, const Common& common) {
  check_outputs({{"--html", html, FileKind::kPlanetPage}}, {argument});
  const auto part = meta_of_part(argument);
  if (part && !html.empty()) {
    throw std::runtime_error(argument +
                             ": cannot make a page of one part of a planet; join the parts with 'vpe merge "
                             "PART... -o PLANET.vpe', then make the page of the whole");
  }
  const auto planet = part ? nullptr : open_planet(argument, common);
  const std::string path = part ? argument : planet->path();
  const paging::PlanetMeta& m = part ? *part : planet->meta();
  if (!html.empty()) base::write_file(html, planet_page(planet, path, common));
  if (common.json) {
    nlohmann::json json = planet_json(m);
    json["path"] = path;
    json["raster"] = is_raster_argument(argument) ? nlohmann::json(argument) : nlohmann::json();
    if (!html.empty()) json["html"] = html;
    print_json(json);
    return;
  }
  if (is_raster_argument(argument)) print_line("raster", argument);
  print_line(is_raster_argument(argument) ? "its planet file" : "file", path);
  if (part) {
    print_line("part", std::to_string(m.shard->id.number) + " of " + std::to_string(m.shard->id.of) +
                           "; 'vpe merge PART... -o PLANET.vpe' joins them");
  }
  for (const Fact& fact : planet_facts(m)) print_line(fact.name.c_str(), fact.value);
  print_level_table(m);
}

}  // namespace

void add_info(CLI::App& program, Common& common) {
  auto planet = std::make_shared<std::string>();
  auto html = std::make_shared<std::string>();
  CLI::App* command = add_command(
      program, "info", "Describe a planet file: body, datum, levels, sources, resampling error", common, true);
  command->add_option("PLANET", *planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option(
      "--html", *html,
      "Write a page too: one HTML file with map, levels, sources, accuracy, slopes and elevations");
  add_examples(*command, {{"what a planet file holds", "vpe info mars.vpe"},
                          {"all figures, with every level, for a program", "vpe info mars.vpe --json"},
                          {"the same as a page, with a map", "vpe info mars.vpe --html mars.html"}});
  command->callback([planet, html, &common] { info(*planet, *html, common); });
}

}  // namespace vpe::app
