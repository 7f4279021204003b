// The first hit of one ray, by binary subdivision of its depths.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "relief/cast/caster.h"
#include "relief/cast/ray_forms.h"
#include "relief/field/height_map.h"
#include "relief/field/surface.h"

namespace relief {

// Describes a ray: the points origin_m + s * direction, s >= 0. The direction may have any length.
struct Ray {
  glm::dvec3 origin_m{0, 0, 0};
  glm::dvec3 direction{0, 0, 0};
};

// Says which depths of a ray are searched, and when a search may end: where the height over the ground is at most
// tolerance * s.
struct RaySpan {
  double s0 = 0;
  double s1 = 0;
  double tolerance = 0;
};

// Holds what a caster asks of a piece's shape again and again.
struct PreparedPiece {
  const HeightMap* map = nullptr;  // the shape, if it is a height map
  bool is_within_support = false;  // the domain of the piece lies in the support of its shape
};

// Finds the hits of rays. Immutable; every const function may be called from any number of threads at once.
class RayCaster {
 public:
  // Expects a surface that outlives it.
  explicit RayCaster(const Surface& surface);

  // Returns the smallest s of the span at which the ray meets the ground of one of the pieces whose bits are set in
  // `pieces`, else kNoHit.
  double first_hit(const Ray& ray, const RaySpan& span, unsigned pieces, CastCounts& counts) const;

  const PreparedPiece& piece(std::size_t n) const { return pieces_[n]; }

 private:
  const Surface& surface_;
  std::vector<PreparedPiece> pieces_;
};

}  // namespace relief
