// Random points of a polygon on the sphere, uniform by area.
//
// Typical usage:
//   const PolygonPoints points(corners);
//   const glm::dvec3 direction = points.point([&] { return chance(); });
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace objects {

// The polygon's edges are great circles; it encloses the smaller side. Poles and the date line are not special.
// Parts that edges enclose an even number of times are outside. Immutable: any thread may call any member.
class PolygonPoints {
 public:
  // Throws std::invalid_argument with what is wrong if the corners are farther than 75 degrees from their middle, or
  // enclose nothing.
  explicit PolygonPoints(std::span<const mars::LonLat> corners);

  // Returns the solid angle. It is right within 1e-9 of it for extents of more than 1e-6 radians.
  double area_sr() const { return until_sr_.back(); }

  // Returns a unit direction. chance() gives a new number in [0, 1) at each call.
  template <class Chance>
  glm::dvec3 point(const Chance& chance) const;

 private:
  struct Triangle {
    glm::dvec3 a, b, c;  // unit
  };

  // Return the point of a triangle's plane, or a zero vector if it is to be drawn again.
  glm::dvec3 candidate(double triangle, double u, double v, double keep) const;
  void add_triangle(const Triangle& triangle);

  std::vector<Triangle> triangles_;
  std::vector<double> until_sr_;  // solid angle up to the end of each triangle
};

template <class Chance>
glm::dvec3 PolygonPoints::point(const Chance& chance) const {
  for (;;) {
    const double triangle = chance();
    const double u = chance();
    const double v = chance();
    const glm::dvec3 direction = candidate(triangle, u, v, chance());
    if (direction != glm::dvec3(0)) return direction;
  }
}

}  // namespace objects
