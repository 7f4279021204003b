#include "vpe/app/planet/info/level_section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/planet/level_table.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace vpe::app {

namespace {

using report::Cell;

constexpr int kFigureDigits = 4;

std::string figure(double value) { return base::format_significant(value, kFigureDigits); }

Cell figure_if(bool is_known, double value) { return is_known ? Cell(figure(value)) : Cell(); }

// Of a level's meshes: the coarsest of each tile.
struct MeshErrors {
  double largest_m = 0;
  double sum_squared = 0;
  std::int64_t tiles = 0;

  double rms_m() const { return std::sqrt(sum_squared / static_cast<double>(tiles)); }
};

std::map<int, MeshErrors> mesh_errors(const lod::TileTree& tree) {
  std::map<int, MeshErrors> errors;
  for (const lod::TileInfo& tile : tree.tiles()) {
    if (tile.variants.empty()) continue;
    MeshErrors& level = errors[tile.key.level];
    const double total_m = tile.variants.front().terms.total_m;
    level.largest_m = std::max(level.largest_m, total_m);
    level.sum_squared += total_m * total_m;
    ++level.tiles;
  }
  return errors;
}

report::Plot error_plot(const paging::PlanetMeta& meta, const std::map<int, MeshErrors>& meshes) {
  report::Plot plot;
  plot.title = "Errors by level";
  plot.x_label = "distance of posts, m";
  plot.y_label = "error, m";
  plot.width_px = 620;
  plot.height_px = 340;
  report::Series mesh{"largest, of meshes", {}, true};
  report::Series mesh_rms{"RMS, of meshes", {}, true};
  report::Series resampling{"largest, resampling", {}, true};
  report::Series resampling_rms{"RMS, resampling", {}, true};
  for (const paging::LevelSummary& level : meta.levels) {
    const double spacing_m = lod::post_spacing_m(level.level, meta.tile.intervals(), meta.radius_m);
    const std::string label = "level " + std::to_string(level.level);
    if (const auto found = meshes.find(level.level); found != meshes.end()) {
      mesh.points.push_back({spacing_m, found->second.largest_m, label, {}, false});
      mesh_rms.points.push_back({spacing_m, found->second.rms_m(), label, {}, false});
    }
    if (level.resampling.posts == 0) continue;
    resampling.points.push_back({spacing_m, level.resampling.max_m, label, {}, false});
    resampling_rms.points.push_back({spacing_m, level.resampling.rms_m, label, {}, false});
  }
  plot.series = {mesh, mesh_rms, resampling, resampling_rms};
  return plot;
}

report::Histogram level_bars(const paging::PlanetMeta& meta, const char* title, const char* y_label,
                             double (*value)(const paging::LevelSummary&)) {
  report::Histogram bars{title, "level", y_label, "", {}, {}, 400, 300};
  for (const paging::LevelSummary& level : meta.levels) {
    const double height = value(level);
    bars.bars.push_back({level.level - 0.4, level.level + 0.4, height,
                         "level " + std::to_string(level.level) + ": " + figure(height)});
  }
  bars.about = "The figures are those of the table of levels.";
  return bars;
}

paging::ResamplingSum resampling_of(const paging::PlanetMeta& meta, int source) {
  paging::ResamplingSum sum;
  for (const paging::LevelSummary& level : meta.levels)
    for (const paging::SourceResampling& own : level.resampling_by_source)
      if (own.source == source) sum.include(sum_of(own.error));
  return sum;
}

}  // namespace

std::string page_text(const std::string& text) {
  return nlohmann::json::parse(core::json_text(nlohmann::json(on_one_line(text)), -1)).get<std::string>();
}

report::Section levels_section(const paging::PlanetFile& planet) {
  const paging::PlanetMeta& meta = planet.meta();
  const std::map<int, MeshErrors> meshes = mesh_errors(planet.tree());
  report::Table table{"levels",
                      "Levels of the planet file, from the coarsest",
                      {{"level", "depth in the quadtree"},
                       {"posts, m", "distance of posts at the middle of a face of the cube", true},
                       {"tiles", "tiles of elevation", true},
                       {"finest", "those without tiles below them", true},
                       {"images", "tiles of imagery", true},
                       {"MB", "compressed size of all of them", true},
                       {"nodata", "posts of finest tiles where no source has data", true},
                       {"mesh, largest, m", "largest geometric error of a mesh", true},
                       {"mesh, RMS, m", "root mean square over tiles of that error", true},
                       {"resampling, RMS, m", "finest tiles against the posts of their sources", true},
                       {"resampling, largest, m", "the same, largest", true}},
                      {}};
  bool has_images_alone = false;
  for (const paging::LevelSummary& l : meta.levels) {
    const auto mesh = meshes.find(l.level);
    const bool has_mesh = mesh != meshes.end();
    const bool is_measured = l.resampling.posts > 0;
    has_images_alone = has_images_alone || (l.tiles == 0 && l.image_tiles > 0);
    table.add({std::to_string(l.level),
               figure(lod::post_spacing_m(l.level, meta.tile.intervals(), meta.radius_m)),
               std::to_string(l.tiles), std::to_string(l.leaf_tiles), std::to_string(l.image_tiles),
               base::format_fixed(1e-6 * static_cast<double>(l.bytes), 1), std::to_string(l.nodata_posts),
               figure_if(has_mesh, has_mesh ? mesh->second.largest_m : 0),
               figure_if(has_mesh, has_mesh ? mesh->second.rms_m() : 0),
               figure_if(is_measured, l.resampling.rms_m), figure_if(is_measured, l.resampling.max_m)});
  }
  report::Section section{
      "Levels",
      {"Ground is drawn from tiles of that level which the view needs. Errors of meshes are radial "
       "distances from the finest ground, of the coarsest mesh of each tile."},
      {error_plot(meta, meshes)},
      {table}};
  if (meta.levels.empty()) section.paragraphs.push_back("Files of format 1.0 do not state their levels.");
  if (has_images_alone)
    section.paragraphs.push_back("Levels without tiles hold imagery that is finer than the ground below it.");
  section.histograms = {
      level_bars(meta, "Size by level", "MB",
                 [](const paging::LevelSummary& l) { return 1e-6 * static_cast<double>(l.bytes); }),
      level_bars(meta, "Tiles by level", "tiles",
                 [](const paging::LevelSummary& l) { return static_cast<double>(l.tiles); })};
  return section;
}

std::vector<report::Table> source_tables(const paging::PlanetMeta& meta, const SourceCoverage& coverage) {
  const double sphere_km2 = 4e-6 * mars::kPi * meta.radius_m * meta.radius_m;
  report::Table ground{"sources",
                       "Sources of elevations",
                       {{"number", "on the maps"},
                        {"name", "path as given to the build, or a built-in source"},
                        {"kind", "data, or made up"},
                        {"posts, m", "distance of its posts where it is finest", true},
                        {"area, %", "of the planet, where it decides the elevation", true},
                        {"area, km\u00b2", "the same, on the planet's sphere", true},
                        {"vertical datum", "of its values as they were used"},
                        {"accuracy, m", "one sigma, vertical, as the product states it", true},
                        {"step, m", "of its values; empty: floating point", true},
                        {"resampling, RMS, m", "the ground against its posts", true},
                        {"resampling, largest, m", "the same, largest", true},
                        {"size", "of its file", true},
                        {"treatment", "what was changed in its values, alignment included"}},
                       {}};
  for (std::size_t n = 0; n < meta.sources.size(); ++n) {
    const mars::SourceInfo& s = meta.sources[n];
    paging::ResamplingError error = resampling_of(meta, static_cast<int>(n)).error();
    if (meta.sources.size() == 1) error = meta.resampling;
    const bool is_measured = error.posts > 0;
    ground.add({std::to_string(n + 1), page_text(s.name), s.illustration ? "synthetic" : "data",
                figure(s.resolution_m), figure(100 * coverage.sources[n].share),
                figure(sphere_km2 * coverage.sources[n].share), to_string(s.datum),
                figure_if(s.accuracy_m.has_value(), s.accuracy_m.value_or(0)),
                figure_if(s.quantum_m > 0, s.quantum_m), figure_if(is_measured, error.rms_m),
                figure_if(is_measured, error.max_m),
                s.size_bytes > 0 ? Cell(bytes_text(static_cast<double>(s.size_bytes))) : Cell(),
                page_text(with_short_numbers(s.treatment))});
  }
  report::Table images{"image-sources",
                       "Sources of imagery",
                       {{"number", "in the order of the build"},
                        {"name", "path as given to the build, or a built-in source"},
                        {"kind", "data, or made up"},
                        {"pixels, m", "distance of its pixels where it is finest", true},
                        {"light", "its own, of a photograph, or none"},
                        {"size", "of its file", true},
                        {"treatment", "what was changed in its values"}},
                       {}};
  for (std::size_t n = 0; n < meta.image_sources.size(); ++n) {
    const mars::SourceInfo& s = meta.image_sources[n];
    images.add({std::to_string(n + 1), page_text(s.name), s.illustration ? "synthetic" : "data",
                figure(s.resolution_m), s.has_own_light ? "a photograph with its own light" : "not stated",
                s.size_bytes > 0 ? Cell(bytes_text(static_cast<double>(s.size_bytes))) : Cell(),
                page_text(with_short_numbers(s.treatment))});
  }
  std::vector<report::Table> tables{ground};
  if (!meta.image_sources.empty()) tables.push_back(images);
  return tables;
}

report::Section accuracy_section(const paging::PlanetFile& planet) {
  const paging::PlanetMeta& meta = planet.meta();
  report::Section section{
      "Accuracy", {"What the file states about how far its ground is from its data."}, {}, {}};
  section.terms.push_back(
      {"resampling error: " + resampling_text(meta.resampling),
       "How far the finest ground lies from posts of the sources, over the whole planet. It is what the "
       "planet file adds to the errors of the data. RMS is the root of the mean square."});
  if (const paging::LevelSummary* finest = finest_measured(meta))
    section.terms.push_back(
        {"at the finest level, " + std::to_string(finest->level) + ": " + resampling_text(finest->resampling),
         "The same where the planet is finest. The figure of the whole planet is mostly that of its "
         "coarse rest."});
  double largest_m = 0;
  for (const lod::TileInfo& tile : planet.tree().tiles())
    if (!tile.variants.empty()) largest_m = std::max(largest_m, tile.variants.front().terms.total_m);
  section.terms.push_back(
      {"geometric error: at most " + length_text(largest_m),
       "The largest distance of a tile's mesh from the finest ground. Images choose meshes so that it stays below their "
       "tolerance in pixels; the certificate of an image states what was reached. The finest meshes have none."});
  section.terms.push_back({"height step: " + length_text(meta.quantum_m),
                           "Heights are stored in whole steps, so that rounding adds at most half of one."});
  bool has_accuracy = false;
  for (const mars::SourceInfo& s : meta.sources) {
    if (!s.accuracy_m) continue;
    has_accuracy = true;
    section.terms.push_back(
        {"accuracy of " + page_text(s.name) + ": " + length_text(*s.accuracy_m),
         "One sigma of its elevations, as the product states it. The program does not check it."});
  }
  if (!has_accuracy)
    section.terms.push_back(
        {"accuracy of the sources: not stated", "No product states how accurate its elevations are."});
  if (meta.illustration)
    section.terms.push_back({"synthetic sources",
                             "Heights of sources marked as synthetic are made up. No figure above "
                             "compares them with true ground."});
  return section;
}

}  // namespace vpe::app
