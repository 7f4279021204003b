#include "vpe/app/planet/info/planet_facts.h"

#include <algorithm>
#include <string_view>

#include "paging/surface/query.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/planet/level_table.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

void add_line(std::vector<Fact>& facts, const char* name, const std::string& value) {
  facts.push_back({name, on_one_line(value)});
}

// Adds a source, and each of its treatments on a line of its own.
void add_source(std::vector<Fact>& facts, const char* what, const mars::SourceInfo& s,
                const std::string& about) {
  add_line(facts, what, s.name + " (" + (s.illustration ? "synthetic, " : "") + about + ")");
  constexpr std::string_view kBetween = "; ";  // mars::add_treatment()
  for (std::size_t at = 0; at < s.treatment.size();) {
    const std::size_t end = std::min(s.treatment.find(kBetween, at), s.treatment.size());
    add_line(facts, "", with_short_numbers(s.treatment.substr(at, end - at)));
    at = end + kBetween.size();
  }
}

}  // namespace

std::vector<Fact> planet_facts(const paging::PlanetMeta& m) {
  std::vector<Fact> facts;
  constexpr int kRadiusDigits = 7;
  const auto is_data = [](const mars::SourceInfo& source) { return !source.illustration; };
  if (m.illustration) {
    add_line(facts, "NOTE",
             std::any_of(m.sources.begin(), m.sources.end(), is_data)
                 ? "sources marked as synthetic are not data"
                 : "an illustration: its numbers are not data");
  }
  add_line(facts, "body", m.body + ", sphere of radius " + length_text(m.radius_m, kRadiusDigits));
  add_line(facts, "vertical datum", paging::describe_datum(m));
  add_line(facts, "heights",
           base::format_rounded(m.lowest_radius_m - m.radius_m, 2) + " m" + " .. " +
               base::format_rounded(m.highest_radius_m - m.radius_m, 2) + " m" + ", stored in steps of " +
               length_text(m.quantum_m));
  add_line(facts, "tiles",
           std::to_string(m.tiles) + " (" + std::to_string(m.leaf_tiles) + " finest) of " +
               std::to_string(m.tile.intervals()) + " intervals, levels 0 .. " +
               std::to_string(m.finest_level));
  add_line(facts, "finest posts",
           length_text(lod::post_spacing_m(m.finest_level, m.tile.intervals(), m.radius_m)));
  add_line(facts, "image",
           m.image_tiles == 0 ? "none"
                              : std::to_string(m.image_tiles) + " tiles, finest texels " +
                                    length_text(lod::post_spacing_m(m.finest_image_level,
                                                                    paging::kImageIntervals, m.radius_m)));
  add_line(facts, "resampling error", resampling_text(m.resampling) + " of the whole planet");
  if (const paging::LevelSummary* finest = finest_measured(m)) {
    add_line(facts, "",
             resampling_text(finest->resampling) + " at the finest level, " + std::to_string(finest->level));
  }
  for (const mars::SourceInfo& s : m.sources)
    add_source(facts, "elevation from", s, length_text(s.resolution_m) + " posts, datum " + to_string(s.datum));
  for (const mars::SourceInfo& s : m.image_sources)
    add_source(
        facts, "image from", s,
        length_text(s.resolution_m) + " pixels" + (s.has_own_light ? ", a photograph with its own light" : ""));
  for (const paging::ImageLayer& layer : m.image_layers) {
    const mars::SourceInfo& source = m.image_sources.at(static_cast<std::size_t>(layer.source));
    add_line(facts, "image layer",
             layer.name + " (" + source.name + ", " + std::to_string(layer.tiles) + " tiles, " +
                 bytes_text(static_cast<double>(layer.bytes)) + ", finest texels " +
                 length_text(lod::post_spacing_m(layer.finest_level, paging::kImageIntervals, m.radius_m)) +
                 ")");
  }
  add_line(facts, "built by", "vpe " + m.program + ", identity " + m.identity);
  return facts;
}

}  // namespace vpe::app
