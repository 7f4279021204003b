// What lies behind the planet.
#pragma once

#include "cull/bounding_region.h"

namespace cull {

// A sphere below all terrain hides what lies behind it. The occluder must be the *lowest* radius of the
// surface (Mars goes 8 km below its datum), sag of its flat triangles included.
struct Horizon {
  double occluder_m = 0;
  double half_tangent = 0;  // tan of half the angle from the camera's direction to its horizon
  bool hides = false;       // false for a camera at or below the occluder: nothing is ever hidden
};
Horizon make_horizon(const Camera& camera, double occluder_radius_m);

// True when the sphere hides every point of radius <= max_radius_m whose squared chord from the camera's
// direction is chord2 or more. Conservative: true only beyond the limit by more than its rounding.
bool hidden(const Horizon& horizon, double chord2, double max_radius_m);

// True unless every ray from the camera to a point of radius <= max_radius_m at squared chord chord2 or less from the
// camera's direction meets the occluder when it is drawn out to both sides: then whatever stands there has ground
// behind it, and never the sky. Conservative: false only by more than its rounding.
bool against_sky(const Camera& camera, const Horizon& horizon, double chord2, double max_radius_m);

}  // namespace cull
