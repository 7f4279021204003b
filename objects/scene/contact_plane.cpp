#include "objects/scene/contact_plane.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace objects {

namespace {

constexpr int kFits = 4;   // the wheels of a tilted plane are closer in a map
constexpr int kLifts = 4;  // lifting moves wheels sideways, as verticals diverge

std::array<glm::dvec3, 4> wheels_of(const ContactPlane& plane, double wheelbase_m, double track_m) {
  const glm::dvec3 ahead = plane.frame.north * (0.5 * wheelbase_m);
  const glm::dvec3 right = plane.frame.east * (0.5 * track_m);
  const glm::dvec3& origin = plane.origin_m;
  return {origin + ahead + right, origin + ahead - right, origin - ahead + right, origin - ahead - right};
}

}  // namespace

ContactPlane contact_plane(const mars::LocalFrame& level, const glm::dvec3& place_m,
                           const std::array<glm::dvec3, 4>& feet_m,
                           const std::function<double(const glm::dvec3& direction)>& ground_radius_m) {
  std::array<glm::dvec3, 4> points;  // to the right, ahead, up
  glm::dvec3 mean{0, 0, 0};
  for (std::size_t n = 0; n < feet_m.size(); ++n) {
    const glm::dvec3 direction = glm::normalize(feet_m[n]);
    const glm::dvec3 offset = direction * ground_radius_m(direction) - place_m;
    points[n] = {glm::dot(offset, level.east), glm::dot(offset, level.north), glm::dot(offset, level.up)};
    mean += 0.25 * points[n];
  }
  double xx = 0;
  double xy = 0;
  double yy = 0;
  double xz = 0;
  double yz = 0;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 p = point - mean;
    xx += p.x * p.x;
    xy += p.x * p.y;
    yy += p.y * p.y;
    xz += p.x * p.z;
    yz += p.y * p.z;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 0)) return {level, place_m + level.up * mean.z};
  const double slope_x = (xz * yy - yz * xy) / determinant;
  const double slope_y = (yz * xx - xz * xy) / determinant;
  ContactPlane plane;
  plane.frame.up = glm::normalize(level.up - level.east * slope_x - level.north * slope_y);
  plane.frame.north = glm::normalize(level.north + level.up * slope_y);
  plane.frame.east = glm::cross(plane.frame.north, plane.frame.up);
  plane.origin_m = place_m + level.up * (mean.z - slope_x * mean.x - slope_y * mean.y);
  return plane;
}

ContactPlane wheel_plane(const mars::LocalFrame& level, double wheelbase_m, double track_m,
                         const std::function<double(const glm::dvec3& direction)>& ground_radius_m) {
  ContactPlane plane{level, level.up * ground_radius_m(level.up)};
  for (int n = 0; n < kFits; ++n) {
    plane = contact_plane(level, plane.origin_m, wheels_of(plane, wheelbase_m, track_m), ground_radius_m);
  }
  for (int n = 0; n < kLifts; ++n) {
    double lift_m = 0;
    for (const glm::dvec3& wheel : wheels_of(plane, wheelbase_m, track_m)) {
      const double radius_m = glm::length(wheel);
      lift_m = std::max(lift_m, ground_radius_m(wheel / radius_m) - radius_m);
    }
    plane.origin_m += level.up * lift_m;
  }
  return plane;
}

}  // namespace objects
