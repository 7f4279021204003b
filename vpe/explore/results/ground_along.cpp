#include "vpe/explore/results/ground_along.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

double share_of(std::int64_t part, std::int64_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0;
}

std::string percent_text(double share) { return base::format_significant(100 * share, 3) + " %"; }

}  // namespace

void GroundAlong::add(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta) {
  const mars::SourceInfo* source =
      answer.source ? &meta.sources.at(static_cast<std::size_t>(*answer.source)) : nullptr;
  ++points;
  nodata += answer.nodata ? 1 : 0;
  synthetic += !answer.nodata && source != nullptr && source->illustration ? 1 : 0;
  finest_spacing_m = std::min(finest_spacing_m, answer.spacing_m);
  coarsest_spacing_m = std::max(coarsest_spacing_m, answer.spacing_m);
  resampling_posts += answer.resampling.posts;
  if (answer.resampling.posts > 0)
    resampling_max_m = std::max(resampling_max_m, double{answer.resampling.max_m});
  if (source != nullptr && !answer.nodata) sources.insert(source->name);
}

double GroundAlong::nodata_share() const { return share_of(nodata, points); }

double GroundAlong::synthetic_share() const { return share_of(synthetic, points); }

GroundAlong ground_along(const paging::Surface& surface, std::span<const mars::LonLat> places) {
  const paging::PlanetMeta& meta = surface.planet().meta();
  GroundAlong ground;
  if (places.size() == 1) ground.add(paging::query(surface, places[0]), meta);
  for (std::size_t n = 1; n < places.size(); ++n) {
    const glm::dvec3 begin = mars::direction(places[n - 1]);
    const glm::dvec3 end = mars::direction(places[n]);
    const double arc_m = mars::angle_between_rad(begin, end) * surface.planet_radius_m();
    const double spacing_m =
        std::min(paging::query(surface, places[n - 1]).spacing_m, paging::query(surface, places[n]).spacing_m);
    const int count =
        static_cast<int>(std::clamp(std::ceil(arc_m / spacing_m) + 1, 2.0, double{kMostGroundPoints}));
    for (int k = 0; k < count; ++k)
      ground.add(paging::query(surface, mars::lon_lat(mars::slerp(begin, end, k / (count - 1.0)))), meta);
  }
  return ground;
}

GroundAlong ground_of_profile(const paging::Surface& surface, std::span<const paging::ProfilePoint> points) {
  GroundAlong ground;
  for (const paging::ProfilePoint& point : points)
    ground.add(paging::query(surface, point.place), surface.planet().meta());
  return ground;
}

nlohmann::json ground_json(const GroundAlong& ground, const paging::PlanetMeta& meta) {
  using nlohmann::json;
  return {{"datum", to_string(meta.datum)},
          {"radius_m", meta.radius_m},
          {"post_spacing_m", ground.points > 0 ? json(ground.finest_spacing_m) : json()},
          {"coarsest_post_spacing_m", ground.coarsest_spacing_m},
          {"resampling_max_m", ground.resampling_posts > 0 ? json(ground.resampling_max_m) : json()},
          {"planet_resampling_max_m", meta.resampling.max_m},
          {"sources", ground.sources},
          {"nodata_share", ground.nodata_share()},
          {"synthetic_share", ground.synthetic_share()},
          {"illustration", meta.illustration}};
}

std::vector<ReadOutLine> ground_lines(const GroundAlong& ground, const paging::PlanetMeta& meta) {
  std::vector<ReadOutLine> lines;
  const auto add = [&](const char* label, std::string text) { lines.push_back({label, std::move(text)}); };
  add("Datum", paging::describe_datum(meta));
  if (ground.points == 0) return lines;
  const std::string finest = measured_length_text(ground.finest_spacing_m);
  const std::string coarsest = measured_length_text(ground.coarsest_spacing_m);
  add("Posts", (finest == coarsest ? finest : finest + " to " + coarsest) + " apart");
  if (ground.resampling_posts > 0)
    add("Error", "at most " + measured_length_text(ground.resampling_max_m) + " from its sources");
  else if (meta.resampling.posts > 0)
    add("Error", "at most " + measured_length_text(meta.resampling.max_m) + " on the planet");
  else
    add("Error", "unknown");
  add("Nodata", percent_text(ground.nodata_share()));
  add("Synthetic", percent_text(ground.synthetic_share()));
  return lines;
}

}  // namespace vpe::explore
