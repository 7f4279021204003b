#include "vpe/app/scene/panorama_lookup.h"

#include <algorithm>
#include <cmath>

namespace vpe::app {

namespace {

// Returns the solid angle of a pixel of the map, steradians.
double texel_sr(const panorama::PanoramaMap& map, double elevation_deg, const glm::dvec2& pixel) {
  const double cosine = std::max(1e-6, std::cos(elevation_deg * mars::kRadiansPerDegree));
  const double column = 2 * mars::kPi / map.turn_px;
  switch (map.kind) {
    case panorama::MapKind::kEquirectangular: return column * cosine / map.focal_px;
    case panorama::MapKind::kCylinder: return column * cosine * cosine * cosine / map.focal_px;
    case panorama::MapKind::kFacets: break;
  }
  const double u = std::fmod(pixel.x + map.crop_left_px, map.facet_px()) - 0.5 * map.facet_px();
  const double along = map.focal_px / std::hypot(map.focal_px, u, map.horizon_px - pixel.y);
  return along * along * along / (map.focal_px * map.focal_px);
}

objects::PanoramaFormula::Kind kind_of(panorama::MapKind kind) {
  using Kind = objects::PanoramaFormula::Kind;
  switch (kind) {
    case panorama::MapKind::kEquirectangular: return Kind::kEquirectangular;
    case panorama::MapKind::kCylinder: return Kind::kCylinder;
    case panorama::MapKind::kFacets: break;
  }
  return Kind::kFacets;
}

}  // namespace

objects::PanoramaLookup panorama_lookup(const panorama::PanoramaMap& map, const glm::dvec2& reduced) {
  return [map, reduced](const glm::dvec3& d) -> std::optional<objects::PanoramaPlace> {
    const double elevation_deg = std::atan2(d.z, std::hypot(d.x, d.y)) / mars::kRadiansPerDegree;
    const auto pixel = map.to_pixel({std::atan2(d.x, d.y) / mars::kRadiansPerDegree, elevation_deg});
    if (!pixel) return std::nullopt;
    return objects::PanoramaPlace{
        *pixel / glm::dvec2(static_cast<double>(map.width_px), static_cast<double>(map.height_px)),
        texel_sr(map, elevation_deg, *pixel) * reduced.x * reduced.y};
  };
}

std::optional<objects::PanoramaFormula> panorama_formula(const panorama::PanoramaMap& map) {
  const auto width_px = static_cast<double>(map.width_px);
  if (width_px > map.turn_px) return std::nullopt;
  return objects::PanoramaFormula{kind_of(map.kind),
                                  width_px,
                                  static_cast<double>(map.height_px),
                                  map.turn_px,
                                  map.turn_azimuth_deg,
                                  map.crop_left_px,
                                  map.horizon_px,
                                  map.focal_px,
                                  map.facets};
}

}  // namespace vpe::app
