// Light of the ground for things that stand on it, from the same posts that colour it.
//
// Typical usage:
//   const GroundLight light(shader, surface, shading_params(appearance, sun, has_image, nullptr));
//   colour *= light.shadow_factor(place_m, 0.5);
#pragma once

#include "paging/shading/terrain_shader.h"
#include "paging/surface/surface.h"
#include "vpe/core/ground_light.h"

namespace paging {

// Reads tiles as it needs them; where one cannot be read, ground keeps its light. Any thread may call any member.
class GroundLight : public vpe::core::GroundLight {
 public:
  // Both must outlive this.
  GroundLight(const TerrainShader& shader, const Surface& surface, ShadingParams params);

  double shadow_factor(const glm::dvec3& place_m, double footprint_m) const override;
  bool sees_sun(const glm::dvec3& place_m) const override;

 private:
  const TerrainShader& shader_;
  const Surface& surface_;
  ShadingParams params_;  // of white ground
};

}  // namespace paging
