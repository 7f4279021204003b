#include "mars/geodesy/sphere.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace mars {

namespace {

// Returns std::remainder(angle_deg, 360), which takes longer than a sine, up to the sign of a zero.
double within_half_turn_deg(double angle_deg) {
  const double size_deg = std::abs(angle_deg);
  if (size_deg <= 180.0) return angle_deg;
  // The difference is exact.
  return size_deg < 540.0 ? angle_deg - std::copysign(360.0, angle_deg) : std::remainder(angle_deg, 360.0);
}

}  // namespace

SinCos sin_cos_deg(double angle_deg) {
  // Multiples of 90 are exact in degrees, so the angle is reduced before it is converted to radians.
  const double reduced = within_half_turn_deg(angle_deg);
  const double quarter = std::nearbyint(reduced / 90.0);
  const double rest_rad = (reduced - quarter * 90.0) * kRadiansPerDegree;
  const double s = std::sin(rest_rad);
  const double c = std::cos(rest_rad);
  if (quarter == 0.0) return {s, c};
  if (quarter == 1.0) return {c, -s};
  if (quarter == -1.0) return {-c, s};
  return {-s, -c};
}

double normalize_lon_deg(double lon_deg) {
  const double lon = std::abs(lon_deg) <= 180.0 ? lon_deg : std::remainder(lon_deg, 360.0);
  return lon <= -180.0 ? 180.0 : lon;
}

bool is_valid(LonLat p) {
  return std::isfinite(p.lon_deg) && std::isfinite(p.lat_deg) && std::abs(p.lat_deg) <= 90.0;
}

glm::dvec3 direction(LonLat p) {
  const SinCos lon = sin_cos_deg(p.lon_deg);
  const SinCos lat = sin_cos_deg(p.lat_deg);
  return {lat.cos * lon.cos, lat.cos * lon.sin, lat.sin};
}

LonLat lon_lat(const glm::dvec3& v) {
  const double horizontal = std::hypot(v.x, v.y);
  const double lon = horizontal == 0.0 ? 0.0 : std::atan2(v.y, v.x) / kRadiansPerDegree;
  return {normalize_lon_deg(lon), std::atan2(v.z, horizontal) / kRadiansPerDegree};
}

LocalFrame local_frame(LonLat p) {
  const SinCos lon = sin_cos_deg(p.lon_deg);
  const SinCos lat = sin_cos_deg(p.lat_deg);
  return {{-lon.sin, lon.cos, 0.0},
          {-lat.sin * lon.cos, -lat.sin * lon.sin, lat.cos},
          {lat.cos * lon.cos, lat.cos * lon.sin, lat.sin}};
}

double angle_between_rad(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double distance_rad(LonLat a, LonLat b) { return angle_between_rad(direction(a), direction(b)); }

double initial_bearing_deg(LonLat a, LonLat b) {
  const LocalFrame frame = local_frame(a);
  const glm::dvec3 to = direction(b);
  const double east = glm::dot(frame.east, to);
  const double north = glm::dot(frame.north, to);
  if (std::hypot(east, north) < 1e-15) return 0.0;
  const double bearing = std::atan2(east, north) / kRadiansPerDegree;
  return bearing < 0.0 ? std::min(bearing + 360.0, std::nextafter(360.0, 0.0)) : bearing;
}

LonLat destination(LonLat a, double bearing_deg, double distance_rad) {
  const LocalFrame frame = local_frame(a);
  const SinCos bearing = sin_cos_deg(bearing_deg);
  const glm::dvec3 ahead = frame.north * bearing.cos + frame.east * bearing.sin;
  return lon_lat(frame.up * std::cos(distance_rad) + ahead * std::sin(distance_rad));
}

glm::dvec3 any_perpendicular(const glm::dvec3& v) {
  const glm::dvec3 helper = std::abs(v.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  return glm::normalize(glm::cross(helper, v));
}

glm::dvec3 slerp(const glm::dvec3& a, const glm::dvec3& b, double t) {
  const double angle = angle_between_rad(a, b);
  // `ahead` is perpendicular to a in the plane of a and b. Cross products keep it accurate for close and for
  // nearly opposite ends, where b - a (a . b) would cancel.
  const glm::dvec3 normal = glm::cross(a, b);
  const double size = glm::length(normal);
  if (size < 1e-300) {
    if (glm::dot(a, b) > 0.0) return a;
    const glm::dvec3 ahead = any_perpendicular(a);
    return glm::normalize(a * std::cos(angle * t) + ahead * std::sin(angle * t));
  }
  const glm::dvec3 ahead = glm::cross(normal / size, a);
  return glm::normalize(a * std::cos(angle * t) + ahead * std::sin(angle * t));
}

double horizon_dip_rad(double alt_m, double radius_m) {
  if (alt_m <= 0.0) return 0.0;
  // atan(distance / R) instead of acos(R / (R + h)): no cancellation for a camera centimetres up.
  return std::atan(horizon_distance_m(alt_m, radius_m) / radius_m);
}

double horizon_distance_m(double alt_m, double radius_m) {
  return alt_m <= 0.0 ? 0.0 : std::sqrt(alt_m * (2.0 * radius_m + alt_m));
}

}  // namespace mars
