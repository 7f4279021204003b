#include "vpe/app/planet/info/info_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "paging/planet/planet_database.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/planet/info/level_section.h"
#include "vpe/app/planet/info/map_readout.h"
#include "vpe/app/planet/info/planet_facts.h"
#include "vpe/app/planet/info/relief_map.h"
#include "vpe/base/nice_ticks.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr double kSteepRelief_deg = 22;  // what the relief of a map is exaggerated to, at its 95th percentile
constexpr double kMostExaggeration = 50;

ReliefLook look_of(const std::vector<GroundStatistics>& levels, const lod::TileTree& tree, double radius_m) {
  ReliefLook look;
  const GroundStatistics& whole = levels[finest_whole_level(levels)];
  if (whole.elevations_m.is_empty()) return look;
  const double low = whole.elevations_m.percentile(0.005);
  const double high = whole.elevations_m.percentile(0.995);
  const double step = base::nice_step_above(std::max(high - low, 1e-3) / 10);
  look.low_m = std::floor(low / step) * step;
  look.high_m = std::ceil(high / step) * step;
  if (!(look.high_m > look.low_m)) look.high_m = look.low_m + step;
  // The level whose posts are about as far apart as the pixels of the map.
  const double pixel_m = 2 * mars::kPi * radius_m / 1024;
  const GroundStatistics* near = &levels.front();
  for (const GroundStatistics& level : levels)
    if (level.baseline_m >= 0.7 * pixel_m || level.level == 0) near = &level;
  if (near->slopes_deg.is_empty()) return look;
  const double steep = std::tan(near->slopes_deg.percentile(0.95) * mars::kRadiansPerDegree);
  const double wanted = std::tan(kSteepRelief_deg * mars::kRadiansPerDegree) / std::max(steep, 1e-9);
  const double most = std::min(kMostExaggeration, 0.5 * tree.exaggeration_limit());
  look.exaggeration = wanted > 1 && most > 1 ? base::nice_step_below(std::min(wanted, most)) : 1;
  return look;
}

// Names lines that continue others like those: each row has a heading of its own.
report::Table facts_table(const std::vector<Fact>& facts) {
  report::Table table{"facts", "What the planet file states", {{"fact", ""}, {"value", ""}}, {}};
  std::string name;
  for (const Fact& fact : facts) {
    if (!fact.name.empty()) name = page_text(fact.name);
    table.add({name, page_text(fact.value)});
  }
  return table;
}

std::vector<Fact> file_facts(const paging::PlanetFile& planet, const std::string& named) {
  const paging::PlanetMeta& m = planet.meta();
  std::error_code none;
  const auto size = std::filesystem::file_size(planet.path(), none);
  const auto rows = paging::read_meta_rows(planet.connect());
  const auto format = rows.find("format");
  std::vector<Fact> facts{{"file", named}};
  if (!none)
    facts.push_back(
        {"file size", bytes_text(static_cast<double>(size)) + " (" + std::to_string(size) + " bytes)"});
  facts.push_back({"format", format == rows.end() ? "not stated" : format->second});
  for (Fact& fact : planet_facts(m)) facts.push_back(std::move(fact));
  facts.push_back({"posts of finest tiles", std::to_string(m.leaf_tiles * m.tile.post_count())});
  std::string arguments;
  for (const std::string& argument : m.arguments) arguments += (arguments.empty() ? "" : " ") + argument;
  facts.push_back({"arguments of the build", m.arguments.empty() ? "not known" : arguments});
  facts.push_back({"time of the build", "the file does not keep it: equal data give equal files"});
  return facts;
}

double synthetic_share(const paging::PlanetMeta& meta, const SourceCoverage& coverage) {
  double share = 0;
  for (std::size_t n = 0; n < meta.sources.size(); ++n)
    if (meta.sources[n].illustration) share += coverage.sources[n].share;
  return share;
}

}  // namespace

std::string planet_page(const std::shared_ptr<const paging::PlanetFile>& planet, const std::string& named,
                        const Common& common) {
  const paging::PlanetMeta& meta = planet->meta();
  const std::size_t budget = static_cast<std::size_t>(common.memory_mb) * 1'000'000 / 2;
  base::ThreadPool pool(common.threads);
  ProgressLine progress(common.quiet);
  const std::vector<GroundStatistics> levels =
      ground_statistics(*planet, pool, [&](double part) { progress.show("slopes", 0.4 * part); });
  const SourceCoverage coverage =
      source_coverage(planet, budget, pool, [&](double part) { progress.show("sources", 0.4 + 0.3 * part); });
  const ReliefLook look = look_of(levels, planet->tree(), meta.radius_m);
  progress.show("map", 0.7);
  const ReliefImages images = relief_images(planet, look, {}, budget, pool);

  report::Page page;
  page.title =
      page_text(meta.body) + ", planet file " + page_text(std::filesystem::path(named).filename().string());
  page.generator = "vpe info";
  page.style = map_style() + readout_style();
  page.script = readout_script();
  if (meta.illustration)
    page.paragraphs.push_back("Some of this planet is made up: sources marked as synthetic are not data.");
  page.sections.push_back({"Planet", {}, {}, {facts_table(file_facts(*planet, named))}});
  report::Section map{"Map", {}, {}, {}};
  map.figures.push_back(relief_figure(images.whole, look, coverage));
  map.figures.back().markup += readout_markup(elevation_grid(planet, budget, pool));
  map.figures.push_back(polar_figure(images, coverage));
  page.sections.push_back(std::move(map));
  page.sections.push_back(levels_section(*planet));

  report::Section sources{"Sources", {}, {}, source_tables(meta, coverage)};
  sources.paragraphs.push_back(
      "Synthetic: " + base::format_significant(100 * synthetic_share(meta, coverage), 4) +
      " % of the area. No data: " + base::format_significant(100 * coverage.nodata_share, 4) + " %.");
  std::vector<std::string> names;
  for (const mars::SourceInfo& source : meta.sources) names.push_back(page_text(source.name));
  sources.figures.push_back(coverage_figure(coverage, names));
  page.sections.push_back(std::move(sources));
  page.sections.push_back(accuracy_section(*planet));
  page.sections.push_back(slopes_section(levels));
  page.sections.push_back(elevations_section(levels));
  return report::to_html(page);
}

}  // namespace vpe::app
