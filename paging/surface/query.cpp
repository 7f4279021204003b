#include "paging/surface/query.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "lod/tree/posts.h"

namespace paging {

PlaceAnswer query(const Surface& surface, mars::LonLat place) {
  PlaceAnswer a;
  a.place = {mars::normalize_lon_deg(place.lon_deg), place.lat_deg};
  const SurfacePoint point = surface.at(mars::direction(place));
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
  const auto tile = surface.tile(point.tile);
  for (const int s : tile->data.source) {
    if (s >= 0 && s < static_cast<int>(meta.sources.size())) {
      a.source += (a.source.empty() ? "" : ";") + meta.sources[static_cast<std::size_t>(s)].name;
    }
  }
  a.geometric_error_m = surface.planet().tree().find(point.tile)->variants.back().terms.total_m;
  a.resampling = meta.resampling;
  for (const LevelSummary& level : meta.levels) {
    if (level.level == point.tile.level) a.resampling_here = level.resampling;
  }
  return a;
}

std::string describe_datum(const PlanetMeta& meta) {
  return to_string(meta.datum) + (meta.shape == "radius" ? " (true radii)" : "");
}

}  // namespace paging
