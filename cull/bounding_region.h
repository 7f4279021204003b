// Bounding regions of terrain: parts of a spherical shell over a rectangle of a cube face's chart, and their
// distances to a camera.
//
// The functions are pure and need no trigonometry. Angles between directions are passed as the squared chord
// between the unit vectors, 4 sin^2(angle / 2), which keeps its relative precision for the smallest angles.
//
// Typical usage:
//   const Camera camera = make_camera(view.camera.position_m);
//   const double chord2 = nearest_chord2(region.rect, camera.direction);
//   const double distance_m = min_distance_m(camera, chord2, region.min_radius_m, region.max_radius_m);
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "mars/geodesy/cube.h"

namespace cull {

// Holds all points whose chart point lies in the rectangle and whose radius lies in [min, max], 0 <= min <=
// max. Flat triangles lie below their posts by their sagitta; the maker of a region must lower min_radius_m by
// it.
struct BoundingRegion {
  mars::ChartRect rect;
  double min_radius_m = 0;
  double max_radius_m = 0;
};

// The convex hull of eight corners that encloses a bounding region. Its faces are the four planes through the
// planet's centre and the rectangle's sides, and two planes perpendicular to the unit centre direction.
// Corners: bit 0 = u1, bit 1 = v1, bit 2 = outer. Exact up to the rounding of the corners, kVolumeError * their
// distance from the centre.
inline constexpr double kVolumeError = 2e-15;
struct BoundingHexahedron {
  glm::dvec3 centre;
  std::array<glm::dvec3, 8> corners_m;
};

// Returns the hexahedron around a region.
BoundingHexahedron bounding_hexahedron(const BoundingRegion& region);

// The position of a camera as unit direction (+X for a camera at the planet's centre) and distance from the
// planet's centre.
struct Camera {
  glm::dvec3 direction;
  double radius_m = 0;
};
Camera make_camera(const glm::dvec3& camera_m);

// Return the squared chord between a unit direction and the nearest or farthest direction of the rectangle; the
// nearest is 0 inside. The chord has an error of at most kChordError.
inline constexpr double kChordError = 1e-15;
double nearest_chord2(const mars::ChartRect& rect, const glm::dvec3& direction);
double farthest_chord2(const mars::ChartRect& rect, const glm::dvec3& direction);

// Returns a lower bound of the distance from a camera to the points of radius [min, max] whose squared chord
// from its direction is at least `chord2`: the exact minimum minus its rounding, 2 kChordError * (camera radius
// + max_radius_m). Returns 0 for a camera in the region.
double min_distance_m(const Camera& camera, double chord2, double min_radius_m, double max_radius_m);

// Returns an upper bound of the distance to the points whose squared chord is at most `chord2`: the exact
// maximum plus its rounding.
double max_distance_m(const Camera& camera, double chord2, double min_radius_m, double max_radius_m);

}  // namespace cull
