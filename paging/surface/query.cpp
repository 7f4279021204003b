#include "paging/surface/query.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "lod/tree/posts.h"
#include "paging/surface/place_cursor.h"

namespace paging {

SlopeAndAspect slope_and_aspect(const glm::dvec3& normal, mars::LonLat place) {
  const mars::LocalFrame frame = mars::local_frame(place);
  const double up = glm::dot(normal, frame.up);
  const double east = glm::dot(normal, frame.east);
  const double north = glm::dot(normal, frame.north);
  SlopeAndAspect out;
  out.slope_deg = std::atan2(std::hypot(east, north), up) / mars::kRadiansPerDegree;
  out.aspect_deg = std::atan2(east, north) / mars::kRadiansPerDegree;
  if (out.aspect_deg < 0) out.aspect_deg += 360;
  return out;
}

PlaceAnswer query(const Surface& surface, mars::LonLat place) {
  PlaceAnswer a;
  a.place = {mars::normalize_lon_deg(place.lon_deg), place.lat_deg};
  PlaceCursor cursor(surface);
  const SurfacePoint& point = cursor.move_to(mars::direction(place));
  const PlanetMeta& meta = surface.planet().meta();
  a.nodata = point.nodata;
  a.elevation_m = point.height_m;
  const SlopeAndAspect slope = slope_and_aspect(point.normal, place);
  a.slope_deg = slope.slope_deg;
  a.aspect_deg = slope.aspect_deg;
  a.level = point.tile.level;
  a.spacing_m = lod::post_spacing_m(point.tile.level, meta.tile.intervals(), meta.radius_m);
  a.geometric_error_m = surface.planet().tree().find(point.tile)->variants.back().terms.total_m;
  a.planet_resampling = meta.resampling;
  a.tile_sources = cursor.sources().of_tile;
  a.source = cursor.source();
  if (!a.source) return a;
  const PlaceCursor::Resampling resampling = cursor.resampling(*a.source);
  a.resampling = resampling.error;
  a.resampling_of_level = resampling.of_level;
  return a;
}

std::optional<int> source_at(const Surface& surface, const glm::dvec3& direction) {
  PlaceCursor cursor(surface);
  cursor.move_to(direction);
  return cursor.source();
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
