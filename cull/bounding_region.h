// Where a tile's terrain lies: part of a spherical shell over a rectangle of a cube face's chart, and its
// distances to a camera. Pure functions; no trigonometry: angles between directions travel as the squared chord
// between the unit vectors, 4 sin^2(angle / 2), which keeps its relative precision for the smallest angles.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "mars/geodesy/cube.h"

namespace cull {

// All points whose chart point lies in the rectangle and whose radius lies in [min, max], 0 <= min <= max.
// Flat triangles sag below their posts: who makes a shell lowers min_radius_m by that beforehand.
struct BoundingRegion {
  mars::ChartRect rect;
  double min_radius_m = 0;
  double max_radius_m = 0;
};

// Convex hull of eight corners that holds a shell: bounded by the four planes through the planet's centre and
// the rectangle's sides and by two planes across the unit centre direction. Corners: bit 0 = u1, bit 1 = v1,
// bit 2 = outer. Exact up to the rounding of the corners, kVolumeError * their distance from the centre.
inline constexpr double kVolumeError = 2e-15;
struct BoundingHexahedron {
  glm::dvec3 centre;
  std::array<glm::dvec3, 8> corners_m;
};
BoundingHexahedron bounding_hexahedron(const BoundingRegion& region);

// A camera as direction (unit; +X for a camera at the planet's centre) and distance from the planet's centre.
struct Camera {
  glm::dvec3 direction;
  double radius_m = 0;
};
Camera make_camera(const glm::dvec3& camera_m);

// Squared chord between a unit direction and the nearest (farthest) direction of the rectangle; 0 inside.
// The chord is right within kChordError.
inline constexpr double kChordError = 1e-15;
double nearest_chord2(const mars::ChartRect& rect, const glm::dvec3& direction);
double farthest_chord2(const mars::ChartRect& rect, const glm::dvec3& direction);

// Lower bound of the distance from a camera to the points of radius [min, max] at `chord2` or more from its
// direction: the exact minimum less its rounding, 2 kChordError * (camera radius + max_radius_m); 0 in the shell.
double min_distance_m(const Camera& camera, double chord2, double min_radius_m, double max_radius_m);

// Upper bound of the distance to the points at `chord2` or less from its direction: the exact maximum plus
// its rounding.
double max_distance_m(const Camera& camera, double chord2, double min_radius_m, double max_radius_m);

}  // namespace cull
