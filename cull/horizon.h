// Horizon culling: finds ground behind the planet.
#pragma once

#include "cull/bounding_region.h"

namespace cull {

// The horizon of a sphere below all terrain, which hides the ground behind it. The occluder must be the
// *lowest* radius of the surface (Mars goes 8 km below its datum), with the sagitta of its flat triangles
// subtracted.
struct Horizon {
  double occluder_m = 0;
  double half_tangent = 0;  // tan of half the angle from the camera's direction to its horizon
  bool hides = false;       // false for a camera on or below the occluder, for which nothing is hidden
};
Horizon make_horizon(const Camera& camera, double occluder_radius_m);

// Returns true if the sphere hides every point of radius <= max_radius_m whose squared chord from the camera's
// direction is chord2 or more. Conservative: true only if the limit is exceeded by more than its rounding.
bool hidden(const Horizon& horizon, double chord2, double max_radius_m);

// Returns true if a tile may be silhouetted against the sky: if some camera ray to a point of radius <=
// max_radius_m, at a squared chord of chord2 or less, misses the occluder sphere when it is extended both ways.
// If false, there is ground behind every point of the tile. Conservative: false only if the limit is exceeded
// by more than its rounding.
bool against_sky(const Camera& camera, const Horizon& horizon, double chord2, double max_radius_m);

}  // namespace cull
