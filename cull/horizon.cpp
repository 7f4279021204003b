#include "cull/horizon.h"

#include <algorithm>
#include <cmath>

namespace cull {

namespace {

// Returns tan(a / 2) of the angle a = acos(occluder / radius), without the cancellation of acos near 1. The
// difference is widened by the rounding of the radii.
double half_tangent(double occluder_m, double radius_m) {
  const double sum = radius_m + occluder_m;
  return std::sqrt((radius_m - occluder_m) / sum + 1e-15);
}

}  // namespace

Horizon make_horizon(const Camera& camera, double occluder_radius_m) {
  if (!(occluder_radius_m > 0.0) || !(camera.radius_m > occluder_radius_m)) return {};
  return {occluder_radius_m, half_tangent(occluder_radius_m, camera.radius_m), true};
}

bool hidden(const Horizon& horizon, double chord2, double max_radius_m) {
  if (!horizon.hides) return false;
  const double a = horizon.half_tangent;
  const double b = half_tangent(horizon.occluder_m, std::max(max_radius_m, horizon.occluder_m));
  // Both angles are below 90 degrees, so the sum of their halves is too: sin((A + B) / 2) from tangents.
  const double numerator = a + b;
  const double rest = 1.0 - a * b;
  const double limit = 2.0 * numerator / std::sqrt(numerator * numerator + rest * rest);
  const double safe = limit * (1.0 + 1e-14) + 4.0 * kChordError;
  return chord2 > safe * safe;
}

// The angle from the nadir to a point grows with its radius, and with its chord up to where the ray touches the
// sphere of its radius. So the highest and farthest point decides.
bool against_sky(const Camera& camera, const Horizon& horizon, double chord2, double max_radius_m) {
  if (!horizon.hides) return true;
  const double cosine = 1.0 - 0.5 * chord2;
  if (!(camera.radius_m > max_radius_m) || cosine * camera.radius_m <= max_radius_m) return true;
  const double sine2 = chord2 * (1.0 - 0.25 * chord2);
  const double below = camera.radius_m - max_radius_m;
  const double range2 = below * below + camera.radius_m * max_radius_m * chord2;
  const double passes2 = camera.radius_m * camera.radius_m * max_radius_m * max_radius_m * sine2 / range2;
  return passes2 >= horizon.occluder_m * horizon.occluder_m * (1.0 - 1e-12);
}

}  // namespace cull
