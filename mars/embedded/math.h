// Arithmetic of the embedded Mars. It uses only integers and + - * / sqrt of IEEE 754, so that every compiler
// and machine gives the same bits (no libm; the build sets -ffp-contract=off).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "mars/geodesy/sphere.h"

namespace mars::embedded {

inline constexpr double kRadius_m = kMarsRadius_m;

// Returns sine and cosine of an angle in degrees by their power series; |error| <= 2e-15 for |angle| <= 720.
constexpr SinCos exact_sin_cos_deg(double angle_deg) {
  while (angle_deg > 180.0) angle_deg -= 360.0;
  while (angle_deg < -180.0) angle_deg += 360.0;
  // The series is evaluated for a quarter of the angle, where 12 terms suffice (45 degrees), and then doubled
  // twice.
  const double x = angle_deg * (kPi / 180.0) / 4.0;
  const double xx = x * x;
  double s = 0.0;
  double versine = 0.0;
  for (int k = 12; k > 0; --k) {
    s = (1.0 + s) * -xx / ((2.0 * k) * (2.0 * k + 1.0));
    versine = (1.0 - versine) * xx / ((2.0 * k - 1.0) * (2.0 * k));
  }
  double sine = x * (1.0 + s);
  double cosine = 1.0 - versine;
  for (int doubling = 0; doubling < 2; ++doubling) {
    const double twice = 2.0 * sine * cosine;
    cosine = 1.0 - 2.0 * sine * sine;
    sine = twice;
  }
  return {sine, cosine};
}

// Returns the unit vector of a place.
constexpr glm::dvec3 place(double lon_deg, double lat_deg) {
  const SinCos lon = exact_sin_cos_deg(lon_deg);
  const SinCos lat = exact_sin_cos_deg(lat_deg);
  return {lat.cos * lon.cos, lat.cos * lon.sin, lat.sin};
}

// Holds up, east and north at a place.
struct PlaceFrame {
  glm::dvec3 up, east, north;
};
constexpr PlaceFrame place_frame(double lon_deg, double lat_deg) {
  const SinCos lon = exact_sin_cos_deg(lon_deg);
  const SinCos lat = exact_sin_cos_deg(lat_deg);
  return {{lat.cos * lon.cos, lat.cos * lon.sin, lat.sin},
          {-lon.sin, lon.cos, 0.0},
          {-lat.sin * lon.cos, -lat.sin * lon.sin, lat.cos}};
}

template <typename T>
constexpr T clamp01(T t) {
  return t < T(0) ? T(0) : (t > T(1) ? T(1) : t);
}

// Returns 0 below `low`, 1 above `high`, and a C1 transition between. low > high gives a falling ramp.
template <typename T>
constexpr T ramp(T low, T high, T x) {
  const T t = clamp01((x - low) / (high - low));
  return t * t * (T(3) - T(2) * t);
}

template <typename T>
constexpr T mix(T a, T b, T t) {
  return a + (b - a) * t;
}

constexpr float magnitude(float x) { return x < 0.0F ? -x : x; }

// Returns the largest integer <= x, |x| < 2^31.
inline std::int32_t floor_int(double x) {
  const auto truncated = static_cast<std::int32_t>(x);
  return truncated - static_cast<std::int32_t>(x < static_cast<double>(truncated));
}

// Returns 64 well mixed bits of a 64-bit key (finaliser of splitmix64).
constexpr std::uint64_t mix_bits(std::uint64_t h) {
  h ^= h >> 30;
  h *= 0xbf58476d1ce4e5b9ULL;
  h ^= h >> 27;
  h *= 0x94d049bb133111ebULL;
  return h ^ (h >> 31);
}

// Returns a fraction in [0, 1) made of 16 of the bits, from bit `shift` on.
constexpr double fraction16(std::uint64_t bits, int shift) {
  return static_cast<double>((bits >> shift) & 0xffff) * (1.0 / 65536.0);
}

// Returns the noise clamped to +-limit, so that outlines stay within known bounds.
constexpr double held(double noise, double limit) {
  return noise < -limit ? -limit : (noise > limit ? limit : noise);
}

// Converts kilometres to a chord of the unit sphere.
constexpr double km_chord(double length_km) { return length_km * 1000.0 / kRadius_m; }

// Returns the square of the distance.
constexpr double chord2(const glm::dvec3& a, const glm::dvec3& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return x * x + y * y + z * z;
}

}  // namespace mars::embedded
