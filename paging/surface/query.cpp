#include "paging/surface/query.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "lod/tree/posts.h"

namespace paging {

namespace {

std::optional<int> nearest_source(const Surface& surface, const TileSources& sources, const SurfacePoint& point,
                                  const glm::dvec3& direction) {
  if (point.nodata) return std::nullopt;
  if (sources.of_post.empty()) return sources.at(0);
  return sources.at(nearest_post(*surface.tile(point.tile), mars::chart_point(direction)));
}

ResamplingError of_source(const std::vector<SourceResampling>& list, int source) {
  for (const SourceResampling& own : list)
    if (own.source == source) return own.error;
  return {};
}

// Files before format 1.3 do not tell sources apart.
ResamplingError level_resampling(const PlanetMeta& meta, int level, int source) {
  for (const LevelSummary& summary : meta.levels) {
    if (summary.level != level) continue;
    return meta.sources.size() == 1 ? summary.resampling : of_source(summary.resampling_by_source, source);
  }
  return {};
}

}  // namespace

PlaceAnswer query(const Surface& surface, mars::LonLat place) {
  PlaceAnswer a;
  a.place = {mars::normalize_lon_deg(place.lon_deg), place.lat_deg};
  const glm::dvec3 direction = mars::direction(place);
  const SurfacePoint point = surface.at(direction);
  const PlanetMeta& meta = surface.planet().meta();
  a.nodata = point.nodata;
  a.elevation_m = point.height_m;
  const mars::LocalFrame frame = mars::local_frame(place);
  const double up = glm::dot(point.normal, frame.up);
  const double east = glm::dot(point.normal, frame.east);
  const double north = glm::dot(point.normal, frame.north);
  a.slope_deg = std::atan2(std::hypot(east, north), up) / mars::kRadiansPerDegree;
  a.aspect_deg = std::atan2(east, north) / mars::kRadiansPerDegree;
  if (a.aspect_deg < 0) a.aspect_deg += 360;
  a.level = point.tile.level;
  a.spacing_m = lod::post_spacing_m(point.tile.level, meta.tile.intervals(), meta.radius_m);
  a.geometric_error_m = surface.planet().tree().find(point.tile)->variants.back().terms.total_m;
  a.planet_resampling = meta.resampling;
  const auto sources = surface.sources(point.tile);
  a.tile_sources = sources->of_tile;
  a.source = nearest_source(surface, *sources, point, direction);
  if (!a.source) return a;
  a.resampling = of_source(sources->resampling, *a.source);
  if (a.resampling.posts > 0) return a;
  a.resampling = level_resampling(meta, point.tile.level, *a.source);
  a.resampling_of_level = a.resampling.posts > 0;
  return a;
}

std::optional<int> source_at(const Surface& surface, const glm::dvec3& direction) {
  const SurfacePoint point = surface.at(direction);
  return nearest_source(surface, *surface.sources(point.tile), point, direction);
}

std::optional<bool> is_synthetic(const Surface& surface, const glm::dvec3& direction) {
  const std::optional<int> source = source_at(surface, direction);
  if (!source) return std::nullopt;
  return surface.planet().meta().sources.at(static_cast<std::size_t>(*source)).illustration;
}

std::string describe_datum(const PlanetMeta& meta) {
  return to_string(meta.datum) + (meta.shape == "radius" ? " (true radii)" : "");
}

}  // namespace paging
