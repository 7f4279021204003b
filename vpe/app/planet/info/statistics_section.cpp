#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/app/cli/figures.h"
#include "vpe/app/planet/info/level_section.h"
#include "vpe/base/nice_ticks.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using base::format_significant;

constexpr std::array<int, 5> kPercentiles{5, 25, 50, 75, 95};
constexpr double kShownShare = 0.999;
constexpr int kMostBars = 50;

std::string percentile_name(int percent) { return std::to_string(percent) + " %"; }

report::Histogram histogram_of(const Distribution& of, double low, double high, const std::string& title,
                               const std::string& x_label, const std::string& unit) {
  const double step = base::nice_step_above((high - low) / kMostBars);
  report::Histogram out{title, x_label, "% of the area", "", {}, {}};
  const double first = std::floor(low / step + 1e-9);
  const double count = std::ceil(high / step - 1e-9) - first;
  for (int n = 0; n < static_cast<int>(count); ++n) {
    const double from = (first + n) * step;
    const double to = (first + n + 1) * step;
    const double share = 100 * of.share_between(from, to);
    out.bars.push_back({from, to, share,
                        base::format_rounded(from, 9) + " to " + base::format_rounded(to, 9) + " " + unit +
                            ": " + format_significant(share, 3) + " %"});
  }
  out.about = "Percentiles:";
  for (const int percent : kPercentiles) {
    const double at = of.percentile(0.01 * percent);
    out.marks.push_back({at, percentile_name(percent)});
    out.about += " " + percentile_name(percent) + " at " + format_significant(at, 4) + " " + unit + ",";
  }
  out.about.back() = '.';
  return out;
}

report::Histogram slope_histogram(const GroundStatistics& level, bool is_whole) {
  const double high = std::max(level.slopes_deg.percentile(kShownShare), 1e-4);
  std::string title = "Slopes at " + length_text(level.baseline_m);
  if (!is_whole) title += ", " + format_significant(100 * level.share_of_planet, 3) + " % of the planet";
  return histogram_of(level.slopes_deg, 0, high, title, "slope, degrees", "degrees");
}

// Returns columns for all percentiles.
void add_percentiles(std::vector<report::Column>& columns, const std::string& unit) {
  for (const int percent : kPercentiles)
    columns.push_back(
        {percentile_name(percent) + ", " + unit, "so much of the area lies below this value", true});
}

}  // namespace

report::Section slopes_section(const std::vector<GroundStatistics>& levels) {
  const GroundStatistics& whole = levels[finest_whole_level(levels)];
  const GroundStatistics& finest = levels.back();
  report::Section section{
      "Slopes",
      {"A slope is the angle between the vertical and the normal of the ground between four neighbouring posts, whose "
       "distance is the baseline: the longer it is, the gentler is the same ground. Each counts with its area. Of a level "
       "with more than " +
           std::to_string(kMostSampledTiles) + " tiles, so many are sampled, evenly spread.",
       "The finest level that covers the whole planet is " + std::to_string(whole.level) + ": " +
           std::to_string(whole.slopes_deg.count()) + " sampled places, baseline " +
           length_text(whole.baseline_m) + "."},
      {},
      {}};
  report::Table table{"slopes",
                      "Percentiles of slopes, weighted by area, at the baseline of each level",
                      {{"level", "depth in the quadtree"},
                       {"baseline, m", "distance of posts", true},
                       {"places", "sampled places", true},
                       {"tiles sampled, %", "of the tiles of the level", true},
                       {"covers, %", "area of the level's tiles, of that of the planet", true}},
                      {}};
  add_percentiles(table.columns, "\u00b0");
  table.columns.push_back({"RMS, \u00b0", "root mean square", true});
  table.columns.push_back({"steepest, \u00b0", "of the sampled places", true});
  for (const GroundStatistics& level : levels) {
    const Distribution& of = level.slopes_deg;
    std::vector<report::Cell> row{
        std::to_string(level.level), format_significant(level.baseline_m, 4), std::to_string(of.count()),
        format_significant(100.0 * static_cast<double>(level.sampled_tiles) / static_cast<double>(level.tiles),
                           3),
        format_significant(100 * level.share_of_planet, 3)};
    for (const int percent : kPercentiles)
      row.push_back(of.is_empty() ? report::Cell() : format_significant(of.percentile(0.01 * percent), 3));
    row.push_back(of.is_empty() ? report::Cell() : format_significant(of.rms(), 3));
    row.push_back(of.is_empty() ? report::Cell() : format_significant(of.highest(), 3));
    table.add(std::move(row));
  }
  section.tables.push_back(std::move(table));
  if (!whole.slopes_deg.is_empty()) section.histograms.push_back(slope_histogram(whole, true));
  if (finest.level != whole.level && !finest.slopes_deg.is_empty())
    section.histograms.push_back(slope_histogram(finest, false));
  return section;
}

report::Section elevations_section(const std::vector<GroundStatistics>& levels) {
  const GroundStatistics& whole = levels[finest_whole_level(levels)];
  const Distribution& of = whole.elevations_m;
  report::Section section{"Elevations",
                          {"Hypsometry: which share of the planet's area has which elevation, by the same " +
                           std::to_string(of.count()) + " places of level " + std::to_string(whole.level) +
                           ". Elevations are means of four posts above the vertical datum."},
                          {},
                          {}};
  if (of.is_empty()) {
    section.paragraphs.push_back("No place of this level has data.");
    return section;
  }
  report::Table table{"elevations",
                      "Elevations, weighted by area",
                      {{"level", "depth in the quadtree"},
                       {"lowest, m", "of the sampled places", true},
                       {"mean, m", "weighted by area", true},
                       {"highest, m", "of the sampled places", true}},
                      {}};
  add_percentiles(table.columns, "m");
  std::vector<report::Cell> row{std::to_string(whole.level), format_significant(of.lowest(), 5),
                                format_significant(of.mean(), 5), format_significant(of.highest(), 5)};
  for (const int percent : kPercentiles) row.push_back(format_significant(of.percentile(0.01 * percent), 5));
  table.add(std::move(row));
  section.tables.push_back(std::move(table));
  const double spread = std::max(of.highest() - of.lowest(), 1e-3);
  section.histograms.push_back(
      histogram_of(of, of.lowest(), of.lowest() + spread, "Elevations", "elevation, m", "m"));
  return section;
}

}  // namespace vpe::app
