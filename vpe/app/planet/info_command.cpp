#include "vpe/app/planet/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "paging/planet/planet_database.h"
#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/level_table.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/planet/planet_json.h"
#include "vpe/base/number.h"

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

// Prints a source, and each of its treatments on a line of its own.
void print_source(const char* what, const mars::SourceInfo& s, const std::string& about) {
  print_line(what, s.name + " (" + (s.illustration ? "synthetic, " : "") + about + ")");
  constexpr std::string_view kBetween = "; ";  // mars::add_treatment()
  for (std::size_t at = 0; at < s.treatment.size();) {
    const std::size_t end = std::min(s.treatment.find(kBetween, at), s.treatment.size());
    print_line("", with_short_numbers(s.treatment.substr(at, end - at)));
    at = end + kBetween.size();
  }
}

void print_meta(const paging::PlanetMeta& m) {
  constexpr int kRadiusDigits = 7;
  const auto is_data = [](const mars::SourceInfo& source) { return !source.illustration; };
  if (m.illustration) {
    print_line("NOTE", std::any_of(m.sources.begin(), m.sources.end(), is_data)
                           ? "sources marked as synthetic are not data"
                           : "an illustration: its numbers are not data");
  }
  print_line("body", m.body + ", sphere of radius " + length_text(m.radius_m, kRadiusDigits));
  print_line("vertical datum", paging::describe_datum(m));
  print_line("heights", base::format_rounded(m.lowest_radius_m - m.radius_m, 2) + " m" + " .. " +
                            base::format_rounded(m.highest_radius_m - m.radius_m, 2) + " m" +
                            ", stored in steps of " + length_text(m.quantum_m));
  print_line("tiles", std::to_string(m.tiles) + " (" + std::to_string(m.leaf_tiles) + " finest) of " +
                          std::to_string(m.tile.intervals()) + " intervals, levels 0 .. " +
                          std::to_string(m.finest_level));
  print_line("finest posts", length_text(lod::post_spacing_m(m.finest_level, m.tile.intervals(), m.radius_m)));
  print_line("image", m.image_tiles == 0 ? "none"
                                         : std::to_string(m.image_tiles) + " tiles, finest texels " +
                                               length_text(lod::post_spacing_m(
                                                   m.finest_image_level, paging::kImageIntervals, m.radius_m)));
  print_line("resampling error", resampling_text(m.resampling) + " of the whole planet");
  if (const paging::LevelSummary* finest = finest_measured(m)) {
    print_line("",
               resampling_text(finest->resampling) + " at the finest level, " + std::to_string(finest->level));
  }
  for (const mars::SourceInfo& s : m.sources)
    print_source("elevation from", s, length_text(s.resolution_m) + " posts, datum " + to_string(s.datum));
  for (const mars::SourceInfo& s : m.image_sources)
    print_source(
        "image from", s,
        length_text(s.resolution_m) + " pixels" + (s.has_own_light ? ", a photograph with its own light" : ""));
  print_line("built by", "vpe " + m.program + ", identity " + m.identity);
}

void info(const std::string& argument, const Common& common) {
  const auto part = meta_of_part(argument);
  const auto planet = part ? nullptr : open_planet(argument, common);
  const std::string path = part ? argument : planet->path();
  const paging::PlanetMeta& m = part ? *part : planet->meta();
  if (common.json) {
    nlohmann::json json = planet_json(m);
    json["path"] = path;
    json["raster"] = is_raster_argument(argument) ? nlohmann::json(argument) : nlohmann::json();
    print_json(json);
    return;
  }
  if (is_raster_argument(argument)) print_line("raster", argument);
  print_line(is_raster_argument(argument) ? "its planet file" : "file", path);
  if (part) {
    print_line("part", std::to_string(m.shard->id.number) + " of " + std::to_string(m.shard->id.of) +
                           "; 'vpe merge PART... -o PLANET.vpe' joins them");
  }
  print_meta(m);
  print_level_table(m);
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
