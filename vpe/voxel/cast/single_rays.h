// Casts rays one by one against the reference surface, where columns do not serve.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): SectorCaster casts what refinement cannot resolve, and
// RangeCaster views that are not made of columns.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "paging/surface/surface.h"
#include "vpe/voxel/cast/tile_fallbacks.h"

namespace vpe::voxel {

// Any thread may call any member.
class SingleRays {
 public:
  // `surface` and `fallbacks` must outlive this. Without fallbacks every tile is read.
  SingleRays(const paging::Surface& surface, double exaggeration, TileFallbacks* fallbacks)
      : surface_(surface), exaggeration_(exaggeration), fallbacks_(fallbacks) {}

  // Returns what paging::Surface::cast() returns, or nullopt if a tile that the ray needs is not there. Throws
  // paging::PlanetError only without fallbacks.
  std::optional<double> cast(const glm::dvec3& camera_m, const glm::dvec3& ray,
                             const paging::Surface::RaySegment& segment = {}) const;

  // Returns the same for a ray that meets nothing before begin_m: casts from there, and from the camera if that place is
  // below the surface.
  std::optional<double> cast_from(const glm::dvec3& camera_m, const glm::dvec3& ray, double begin_m) const;

  // Returns the same for a ray that probably meets the surface near one of two ranges: casts about the nearer
  // one, then from the farther one on, and from the camera if either lies too far (the retrace of Wan 1999,
  // section 4).
  std::optional<double> cast_near(const glm::dvec3& camera_m, const glm::dvec3& ray, float a_m,
                                  float b_m) const;

 private:
  const paging::Surface& surface_;
  double exaggeration_;
  TileFallbacks* fallbacks_;
};

// A ray is cast over this share of a range before and behind it.
inline constexpr double kAroundRange = 0.04;

}  // namespace vpe::voxel
