#include "vpe/app/contour/grid_report.h"

#include "paging/surface/query.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

std::string four_digits(double value) { return base::format_significant(value, 4); }

double share_of_posts(std::int64_t part, const map::MapGround& ground) {
  return ground.pixels > 0 ? static_cast<double>(part) / static_cast<double>(ground.pixels) : 0;
}

std::string percent_of_posts(std::int64_t part, const map::MapGround& ground) {
  return base::format_significant(100 * share_of_posts(part, ground), 3) + " %";
}

std::string known_error(const map::MapGround& ground) {
  return ground.error_max_m >= 0 ? "at most " + four_digits(ground.error_max_m) + " m" : "unknown";
}

std::vector<std::string> source_names(const map::MapGround& ground, const paging::PlanetMeta& meta) {
  std::vector<std::string> names;
  for (const int source : ground.sources)
    names.push_back(meta.sources.at(static_cast<std::size_t>(source)).name);
  return names;
}

}  // namespace

map::GroundGrid sample_with_progress(const std::shared_ptr<const paging::PlanetFile>& planet,
                                     const map::GridFrame& frame, const Common& common, ProgressLine& line) {
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  return map::sample_ground(surface, frame, common.threads, [&](double share) {
    InterruptGuard::check();
    line.show("heights", share);
  });
}

nlohmann::json grid_json(const map::GridFrame& frame, const map::MapGround& ground,
                         const paging::PlanetMeta& meta) {
  using nlohmann::json;
  return {{"spacing_m", frame.spacing_m},
          {"columns", frame.columns},
          {"rows", frame.rows},
          {"map_centre", {{"lon_deg", frame.map.centre().lon_deg}, {"lat_deg", frame.map.centre().lat_deg}}},
          {"map_scale_error", frame.scale_error()},
          {"datum", to_string(meta.datum)},
          {"radius_m", meta.radius_m},
          {"post_spacing_m", ground.finest_spacing_m},
          {"coarsest_post_spacing_m", ground.coarsest_spacing_m},
          {"resampling_max_m", ground.error_max_m >= 0 ? json(ground.error_max_m) : json()},
          {"planet_resampling_max_m", meta.resampling.max_m},
          {"sources", source_names(ground, meta)},
          {"nodata_share", share_of_posts(ground.nodata, ground)},
          {"synthetic_share", share_of_posts(ground.synthetic, ground)},
          {"illustration", meta.illustration}};
}

std::string grid_text(const map::GridFrame& frame, const map::MapGround& ground,
                      const paging::PlanetMeta& meta) {
  std::string text = "grid:            " + std::to_string(frame.columns) + " x " + std::to_string(frame.rows) +
                     " posts, " + four_digits(frame.spacing_m) + " m apart; lengths on the map within " +
                     base::format_significant(100 * frame.scale_error(), 2) + " %\n";
  text += "datum:           " + on_one_line(paging::describe_datum(meta)) + "\n";
  text += "resolution:      the planet's posts are " + four_digits(ground.finest_spacing_m) + " to " +
          four_digits(ground.coarsest_spacing_m) + " m apart\n";
  text += "error:           ground against its sources' posts: " + known_error(ground) + "\n";
  for (const std::string& source : source_names(ground, meta))
    text += "source:          " + on_one_line(source) + "\n";
  text += "nodata:          " + percent_of_posts(ground.nodata, ground) + " of the grid\n";
  text += "synthetic:       " + percent_of_posts(ground.synthetic, ground) + " of the grid\n";
  return text;
}

mars::FeatureFileInfo feature_info(const std::string& what, const map::GridFrame& frame,
                                   const map::MapGround& ground, const paging::PlanetMeta& meta) {
  mars::FeatureFileInfo info;
  info.radius_m = meta.radius_m;
  info.body = meta.body;
  std::string sources;
  for (const std::string& source : source_names(ground, meta))
    sources += (sources.empty() ? "" : "; ") + source;
  info.description = "vpe " + what + ". Heights count from " + paging::describe_datum(meta) +
                     ". They were taken " + four_digits(frame.spacing_m) + " m apart from ground with posts " +
                     four_digits(ground.finest_spacing_m) + " to " + four_digits(ground.coarsest_spacing_m) +
                     " m apart, whose difference from the posts of its sources is " + known_error(ground) +
                     ". Sources: " + sources + ". Nodata: " + percent_of_posts(ground.nodata, ground) +
                     " of the area. Synthetic: " + percent_of_posts(ground.synthetic, ground) + " of the area.";
  return info;
}

}  // namespace vpe::app
