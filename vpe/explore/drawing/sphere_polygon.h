// Lengths, areas and crossings of outlines on the sphere, whose edges are the shorter great circles.
//
// All functions are pure and may be called from any thread.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {

// Returns the directions of places.
std::vector<glm::dvec3> directions_of(std::span<const mars::LonLat> places);

// Return the length of a line through unit directions, and of the closed outline of a polygon, in radians. The
// error is at most 1e-15 for each edge, and 1e-15 of the length.
double line_length_rad(std::span<const glm::dvec3> line);
double outline_length_rad(std::span<const glm::dvec3> polygon);

// Returns the solid angle on the left of an outline of unit directions, counted once for each time that the
// outline winds about it, reduced to [-2 pi, 2 pi]. It is positive if the smaller side is on the left (the
// outline runs counterclockwise about it, seen from outside). An outline that does not cross itself encloses
// its absolute value: the area of the smaller side on the unit sphere, whatever the orientation; poles and the
// date line are not special. The method is the sum of spherical excesses of triangles (Eriksson 1990,
// Mathematics Magazine 63).
//
// The error is at most kSphereAreaError times the outline's length, in radians, if all vertices lie within 80
// degrees of the first one, else kLargeSphereAreaError.
inline constexpr double kSphereAreaError = 3e-15;
inline constexpr double kLargeSphereAreaError = 1e-12;
double signed_sphere_area(std::span<const glm::dvec3> polygon);

// Holds a signed solid angle before it is reduced: the sum over the triangles (reference, a, b) of all edges.
struct FanArea {
  glm::dvec3 reference{0, 0, 1};
  double sum = 0;
  int whole_spheres = 0;  // (sum - signed_sphere_area()) / 4 pi
};
FanArea fan_area(std::span<const glm::dvec3> polygon);

// Returns two edges (by the index of their first vertex) of a closed outline that cross or touch, other than
// neighbours at their common vertex, or nullopt. Edges without length are ignored. Takes about n log n steps
// for outlines whose edges are short against their extent.
std::optional<std::pair<std::size_t, std::size_t>> crossing_edges(std::span<const glm::dvec3> polygon);

}  // namespace vpe::explore
