#include "cull/bounding_region.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace cull {

namespace {

// A direction in the axes of a face.
struct FaceDirection {
  double x, y, z;
};

FaceDirection on_face(mars::Face face, const glm::dvec3& d) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  return {glm::dot(axes.right, d), glm::dot(axes.up, d), glm::dot(axes.out, d)};
}

double corner_chord2(const FaceDirection& d, double u, double v) {
  const double scale = 1.0 / std::sqrt(u * u + v * v + 1.0);
  const double x = d.x - u * scale;
  const double y = d.y - v * scale;
  const double z = d.z - scale;
  return x * x + y * y + z * z;
}

std::array<double, 4> corner_chords2(const FaceDirection& d, const mars::ChartRect& rect) {
  return {corner_chord2(d, rect.u0, rect.v0), corner_chord2(d, rect.u1, rect.v0),
          corner_chord2(d, rect.u0, rect.v1), corner_chord2(d, rect.u1, rect.v1)};
}

// Returns the smaller of `otherwise` and the squared chord from a direction to the arc of the chart line x / z
// = line between y / z = low and high. Returns `otherwise` for a direction on the rectangle's side of the line
// (side >= 0, the signed distance x - line z), and if the foot of the perpendicular is not on the arc.
double arc_chord2(double x, double y, double z, double line, double low, double high, double side,
                  double otherwise) {
  const double size2 = 1.0 + line * line;
  const double foot_z = (line * x + z) / size2;
  if (side >= 0.0 || y < low * foot_z || y > high * foot_z) return otherwise;
  const double sine2 = std::min(side * side / size2, 1.0);
  return std::min(otherwise, 2.0 * sine2 / (1.0 + std::sqrt(1.0 - sine2)));
}

}  // namespace

BoundingHexahedron bounding_hexahedron(const BoundingRegion& region) {
  const mars::ChartRect& rect = region.rect;
  const std::array<glm::dvec3, 4> rays{
      mars::chart_direction(rect.face, rect.u0, rect.v0), mars::chart_direction(rect.face, rect.u1, rect.v0),
      mars::chart_direction(rect.face, rect.u0, rect.v1), mars::chart_direction(rect.face, rect.u1, rect.v1)};
  BoundingHexahedron volume;
  volume.centre = glm::normalize(rays[0] + rays[1] + rays[2] + rays[3]);
  std::array<double, 4> cosines;
  for (std::size_t k = 0; k < 4; ++k) cosines[k] = glm::dot(volume.centre, rays[k]);
  // No direction of the rectangle is farther from its centre than the farthest corner.
  const double inner_m = region.min_radius_m * *std::min_element(cosines.begin(), cosines.end());
  for (std::size_t k = 0; k < 4; ++k) {
    volume.corners_m[k] = rays[k] * (inner_m / cosines[k]);
    volume.corners_m[k + 4] = rays[k] * (region.max_radius_m / cosines[k]);
  }
  return volume;
}

Camera make_camera(const glm::dvec3& camera_m) {
  const double radius = glm::length(camera_m);
  return radius > 0.0 ? Camera{camera_m / radius, radius} : Camera{{1, 0, 0}, 0.0};
}

double nearest_chord2(const mars::ChartRect& rect, const glm::dvec3& direction) {
  const FaceDirection d = on_face(rect.face, direction);
  // Behind the face (z < 0) low z > high z, so that no direction lies between, here and on the arcs.
  const double west = d.x - rect.u0 * d.z;
  const double east = rect.u1 * d.z - d.x;
  const double south = d.y - rect.v0 * d.z;
  const double north = rect.v1 * d.z - d.y;
  if (west >= 0.0 && east >= 0.0 && south >= 0.0 && north >= 0.0) return 0.0;
  const std::array<double, 4> corners = corner_chords2(d, rect);
  double best = *std::min_element(corners.begin(), corners.end());
  best = arc_chord2(d.x, d.y, d.z, rect.u0, rect.v0, rect.v1, west, best);
  best = arc_chord2(d.x, d.y, d.z, rect.u1, rect.v0, rect.v1, east, best);
  best = arc_chord2(d.y, d.x, d.z, rect.v0, rect.u0, rect.u1, south, best);
  best = arc_chord2(d.y, d.x, d.z, rect.v1, rect.u0, rect.u1, north, best);
  return best;
}

double farthest_chord2(const mars::ChartRect& rect, const glm::dvec3& direction) {
  // Beyond 90 degrees the farthest point is the antipode's nearest, and 4 - x loses no precision. Within 90
  // degrees caps are convex, so that a corner is farthest.
  const double opposite = nearest_chord2(rect, -direction);
  if (opposite < 2.0) return 4.0 - opposite;
  const std::array<double, 4> corners = corner_chords2(on_face(rect.face, direction), rect);
  return *std::max_element(corners.begin(), corners.end());
}

double min_distance_m(const Camera& camera, double chord2, double min_radius_m, double max_radius_m) {
  const double radius = std::clamp(camera.radius_m * (1.0 - 0.5 * chord2), min_radius_m, max_radius_m);
  const double radial = camera.radius_m - radius;
  const double distance = std::sqrt(radial * radial + camera.radius_m * radius * chord2);
  return std::max(0.0, distance - 2.0 * kChordError * (camera.radius_m + max_radius_m));
}

double max_distance_m(const Camera& camera, double chord2, double min_radius_m, double max_radius_m) {
  // The distance is convex in the radius, so one of the ends is farthest.
  const auto squared = [&](double radius) {
    const double radial = camera.radius_m - radius;
    return radial * radial + camera.radius_m * radius * chord2;
  };
  const double distance = std::sqrt(std::max(squared(min_radius_m), squared(max_radius_m)));
  return distance + 2.0 * kChordError * (camera.radius_m + max_radius_m);
}

}  // namespace cull
