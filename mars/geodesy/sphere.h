// The planet's sphere: directions, longitude and latitude, great circles, local frames.
//
// Body-fixed frame: right-handed, +Z the north pole, +X through longitude 0 latitude 0. Longitude is
// east-positive in (-180, 180], latitude planetocentric. Directions are unit vectors of that frame.
// All functions are pure and may be called from any thread. Bounds are tested in
// tests/mars/sphere_test.cpp over random and hostile inputs.
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

// Sine and cosine of an angle in degrees; exact (0, +-1) at multiples of 90, else within 2 ulp for any finite
// angle. NaN for NaN and infinities.
struct SinCos {
  double sin;
  double cos;
};
SinCos sin_cos_deg(double angle_deg);

// Longitude in (-180, 180]; NaN and infinities come back as NaN.
double normalize_lon_deg(double lon_deg);

// True when both are finite and |lat| <= 90.
bool is_valid(LonLat p);

// Unit vector of a place. Error of the angle: <= kDirectionError_rad. lat = +-90 gives exactly (0, 0, +-1).
inline constexpr double kDirectionError_rad = 4.5e-16;
glm::dvec3 direction(LonLat p);

// Inverse of direction() for any non-zero vector (length is ignored); at the poles lon = 0.
// direction(lon_lat(v)) is within kLonLatError_rad of v / |v|.
inline constexpr double kLonLatError_rad = 1.5e-15;
LonLat lon_lat(const glm::dvec3& v);

// East, north, up at a place. At the poles north is the limit along the given meridian, so that the frame
// depends on p.lon_deg there. Lengths and products are those of an orthonormal frame within kFrameError.
inline constexpr double kFrameError = 5e-16;
struct LocalFrame {
  glm::dvec3 east;
  glm::dvec3 north;
  glm::dvec3 up;
};
LocalFrame local_frame(LonLat p);

// Angle between two vectors, 0..pi, also for nearly equal and nearly opposite ones. Lengths must lie in
// 1e-60..1e60. Error <= angle_error_rad(angle).
constexpr double angle_error_rad(double angle_rad) { return 2e-16 + 4e-16 * angle_rad; }
double angle_between_rad(const glm::dvec3& a, const glm::dvec3& b);

// Great circles. Distances are central angles in radians; multiply by the radius for metres.
double distance_rad(LonLat a, LonLat b);
// Heading at a towards b, degrees clockwise from north in [0, 360); 0 where it is undefined (a = b, antipodes).
// Error <= kBearingError_rad (1 + 1 / sin(distance)).
inline constexpr double kBearingError_rad = 1e-15;
double initial_bearing_deg(LonLat a, LonLat b);
// The place reached from a after `distance_rad` (negative: backwards) along the great circle that leaves with
// `bearing_deg`. Error <= kDestinationError_rad for distances within a turn.
inline constexpr double kDestinationError_rad = 2e-15;
LonLat destination(LonLat a, double bearing_deg, double distance_rad);
// Point at fraction t (any real) of the way from unit a to unit b along the shorter great circle; length
// 1 within 4e-16. For antipodes some great circle is taken, the same one for every t. For t in [0, 1] the error
// of the place is <= kSlerpError_rad * max(1, sin(t angle) / sin(angle)).
inline constexpr double kSlerpError_rad = 1e-15;
glm::dvec3 slerp(const glm::dvec3& a, const glm::dvec3& b, double t);

// Some unit vector perpendicular to unit v, both within 4e-16; a function of v that is continuous except at
// |v.z| = 0.9.
glm::dvec3 any_perpendicular(const glm::dvec3& v);

// Angle below the local horizontal of the horizon of a sphere, seen from `alt_m` above it; 0 at or below it.
double horizon_dip_rad(double alt_m, double radius_m);
// Straight distance from the camera to that horizon: sqrt(2 R h + h^2). Relative error of both <= kHorizonError.
inline constexpr double kHorizonError = 6e-16;
double horizon_distance_m(double alt_m, double radius_m);

}  // namespace mars
