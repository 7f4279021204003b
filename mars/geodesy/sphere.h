// Geometry of the planet's sphere: directions, longitude and latitude, great circles, local frames.
//
// Body-fixed frame: right-handed, +Z points to the north pole, +X to longitude 0 and latitude 0. Longitude is
// east-positive in (-180, 180], latitude is planetocentric. Directions are unit vectors of that frame.
// All functions are pure and may be called from any thread. tests/mars/sphere_test.cpp checks the error bounds
// over random and hostile inputs.
//
// Typical usage:
//   const glm::dvec3 d = direction({137.4, -4.6});
//   const double metres = kMarsRadius_m * distance_rad({137.4, -4.6}, lon_lat(d));
#pragma once

#include <glm/vec3.hpp>

namespace mars {

inline constexpr double kMarsRadius_m = 3396190.0;
inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadiansPerDegree = kPi / 180.0;

struct LonLat {
  double lon_deg = 0;
  double lat_deg = 0;
};

struct SinCos {
  double sin;
  double cos;
};

// Returns sine and cosine of an angle in degrees: exact (0, +-1) at multiples of 90, else within 2 ulp for any
// finite angle. Returns NaN for NaN and infinities.
SinCos sin_cos_deg(double angle_deg);

// Returns the longitude in (-180, 180]. Returns NaN for NaN and infinities.
double normalize_lon_deg(double lon_deg);

// Returns true if both are finite and |lat| <= 90.
bool is_valid(LonLat p);

// Bounds the angular error of direction().
inline constexpr double kDirectionError_rad = 4.5e-16;

// Returns the unit vector of a place. lat = +-90 gives exactly (0, 0, +-1).
glm::dvec3 direction(LonLat p);

// Bounds the angle between v and direction(lon_lat(v)).
inline constexpr double kLonLatError_rad = 1.5e-15;

// Returns the place of any non-zero vector: the inverse of direction(). The length is ignored. Returns lon = 0
// at the poles.
LonLat lon_lat(const glm::dvec3& v);

struct LocalFrame {
  glm::dvec3 east;
  glm::dvec3 north;
  glm::dvec3 up;
};

// Bounds how much lengths and products of a local frame differ from those of an orthonormal one.
inline constexpr double kFrameError = 5e-16;

// Returns east, north and up at a place. At a pole north is the limit along the meridian of p.lon_deg, so the
// frame depends on p.lon_deg there.
LocalFrame local_frame(LonLat p);

// Bounds the error of angle_between_rad().
constexpr double angle_error_rad(double angle_rad) { return 2e-16 + 4e-16 * angle_rad; }

// Returns the angle between two vectors, 0 to pi. Accurate also for nearly equal and nearly opposite vectors.
// Lengths must be in 1e-60..1e60.
double angle_between_rad(const glm::dvec3& a, const glm::dvec3& b);

// Returns the central angle of two places. Multiply it by the radius for metres.
double distance_rad(LonLat a, LonLat b);

// The error of initial_bearing_deg() is at most kBearingError_rad * (1 + 1 / sin(distance)).
inline constexpr double kBearingError_rad = 1e-15;

// Returns the heading at a towards b along the great circle, degrees clockwise from north in [0, 360). Returns
// 0 where it is undefined (a = b, antipodes).
double initial_bearing_deg(LonLat a, LonLat b);

// Bounds the error of destination() for distances within a full circle.
inline constexpr double kDestinationError_rad = 2e-15;

// Returns the place reached from a after `distance_rad` (negative: backwards) along the great circle that
// leaves with `bearing_deg`.
LonLat destination(LonLat a, double bearing_deg, double distance_rad);

// For t in [0, 1] the error of slerp() is at most kSlerpError_rad * max(1, sin(t angle) / sin(angle)).
inline constexpr double kSlerpError_rad = 1e-15;

// Returns the point at fraction t (any real number) of the way from unit a to unit b along the shorter great
// circle. Its length is 1 within 4e-16. For antipodes one of the great circles is chosen, the same for every t.
glm::dvec3 slerp(const glm::dvec3& a, const glm::dvec3& b, double t);

// Returns a unit vector perpendicular to unit v, both within 4e-16. It is a function of v, continuous except at
// |v.z| = 0.9.
glm::dvec3 any_perpendicular(const glm::dvec3& v);

// Bounds the relative error of the two functions below.
inline constexpr double kHorizonError = 6e-16;

// Returns the angle of a sphere's horizon below the local horizontal, seen from `alt_m` above the sphere.
// Returns 0 for alt_m <= 0.
double horizon_dip_rad(double alt_m, double radius_m);

// Returns the straight distance from the camera to that horizon: sqrt(2 R h + h^2).
double horizon_distance_m(double alt_m, double radius_m);

}  // namespace mars
