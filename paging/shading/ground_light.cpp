#include "paging/shading/ground_light.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "vpe/core/appearance/shading.h"

namespace paging {

GroundLight::GroundLight(const TerrainShader& shader, const Surface& surface, ShadingParams params)
    : shader_(shader), surface_(surface), params_(std::move(params)) {
  params_.colour_source = ColourSource::kPlain;
  params_.hue = ColourSource::kPlain;
  params_.scale = nullptr;
  params_.plain = glm::dvec3(1);
  params_.flat = false;
}

double GroundLight::shadow_factor(const glm::dvec3& place_m, double footprint_m) const {
  if (!params_.lit) return 1;
  try {
    TerrainShader::Cursor cursor;
    const std::optional<glm::dvec3> lit = shader_.colour_at(place_m, footprint_m, params_, cursor);
    if (!lit || !(lit->x > 0)) return 1;
    return std::min(1.0, vpe::core::light(params_.ambient, params_.diffuse, 0) / lit->x);
  } catch (const PlanetError&) {
    return 1;
  }
}

bool GroundLight::sees_sun(const glm::dvec3& place_m) const {
  if (!params_.shadows) return true;
  try {
    return std::isinf(surface_.cast(place_m, params_.sun, params_.exaggeration));
  } catch (const PlanetError&) {
    return true;
  }
}

}  // namespace paging
