// Casting of rays at surfaces of relief, without triangles.
//
// The method is that of Vyatkin and Dolgovesov 2002 (section 2). The screen is divided into quarters down to pixels, and
// each part of it, with its interval of depths, into a near and a far half; the near half comes first. Intervals of the
// height above the base and of the relief decide whether a part can meet the ground. Pixels that have their hit are
// masked. docs/design/relief.md has the bounds and their reasons.
//
// A hit is the first place of a ray, between the limits, at which the height over the ground changes its sign or is 0,
// from either side: a camera in the ground sees it from below.
//
// Typical usage:
//   const CastResult found = cast(surface, view, {.tolerance_px = 0.5}, pool);
//   if (found.range_m[0] < kNoHit) normal = surface.normal(view.camera.position_m + found.range_m[0] * pixel_ray(...));
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "relief/field/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"

namespace relief {

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();
inline constexpr double kFarthest_m = 1e15;

// Bounds what is searched, and how exactly.
struct CastOptions {
  // Ranges along the ray that are searched; 0 <= near_m < far_m <= kFarthest_m.
  double near_m = 0;
  double far_m = kFarthest_m;
  // 0: the first root of the smooth surface. Else a search may end where the height over the ground is at most as many
  // metres as this many pixels are wide there (at the principal point): then the time depends on the image rather than
  // on the map. A ray that passes above the ground within that height may count as a hit. 0 to 1000.
  double tolerance_px = 0;
};

// Counts the work of a cast. The numbers depend on surface, view and options alone.
struct CastCounts {
  std::int64_t bundles = 0;  // bounds of a part of the screen in an interval of depths
  std::int64_t steps = 0;    // bounds of a single ray in an interval of depths
  std::int64_t patches = 0;  // roots that were looked for on one patch
};

struct CastResult {
  int width = 0;
  int height = 0;
  std::vector<double> range_m;  // along the rays of the drawn part's pixels, row by row; kNoHit where none is
  CastCounts counts;
};

// Casts the pixels of a view's drawn part. The result does not depend on the pool. Perspective views use the screen's
// quarters, others cast each ray alone. Errors of a range: 1e-12 of it and of the distance from the base's centre, on
// ground that the ray meets at an angle, if tolerance_px is 0; else what moves the point by the tolerance.
//
// On height maps no crossing is missed, but where ray and ground stay within 1e-10 of the range of each other. On other
// shapes two crossings closer together than 1e-9 of the range may be missed.
// Throws std::invalid_argument for a view that check() refuses, or options beyond their limits.
CastResult cast(const Surface& surface, const vpe::core::View& view, const CastOptions& options,
                vpe::base::ThreadPool& pool);

// Returns the range of the first hit of a ray from near_m to far_m, exactly as cast() without a tolerance, else kNoHit.
// Throws std::invalid_argument for a direction that is not a unit vector within 1e-9, or limits that cast() refuses.
double cast_ray(const Surface& surface, const glm::dvec3& origin_m, const glm::dvec3& direction,
                double near_m = 0, double far_m = kFarthest_m);

}  // namespace relief
