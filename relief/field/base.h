// Base surfaces of relief: plane, sphere, ellipsoid, quadric.
//
// A base gives each point of space a height above it in metres, whose zeros are the surface. Vyatkin and
// Dolgovesov 2002 (section 2) call that function F. All four are functions of one or two polynomials of second
// degree, which casters bound along rays.
//
//   plane      n . (p - o)
//   sphere     |p - c| - R
//   ellipsoid  |p - c| (1 - 1 / g(p)),  g the norm whose unit sphere it is: the length of the way from the surface to
//              p on the ray from the centre
//   quadric    F(p) / |grad F(a)|: metres along the normal at the anchor a, to first order; elsewhere in units of
//              |grad F(p)| / |grad F(a)| metres
//
// Everything is a pure function of values and may be called from any thread.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "relief/shape.h"

namespace relief {

// Holds constant + 2 linear . d + d . matrix d of d = p - centre_m. The matrix is symmetric.
struct Quadratic {
  glm::dvec3 centre_m{0, 0, 0};
  glm::dmat3 matrix{0.0};
  glm::dvec3 linear{0, 0, 0};
  double constant = 0;

  double value(const glm::dvec3& p_m) const;
  glm::dvec3 gradient(const glm::dvec3& p_m) const;
};

// Holds the points between two corners, borders included.
struct Box {
  glm::dvec3 low_m{0, 0, 0};
  glm::dvec3 high_m{0, 0, 0};
};

// Bound the values of a polynomial over a box: the first-order part is exact, the rest is of second order.
Interval bounds(const Quadratic& polynomial, const Box& box);

// Describes a base surface.
class Base {
 public:
  enum class Kind : std::uint8_t { kPlane, kSphere, kEllipsoid, kQuadric };

  // Make a base. Throw std::invalid_argument if a number is not finite, a length is not positive, a normal is 0, or the
  // axes are not orthonormal within 1e-9. The columns of `axes` are the directions of the semi-axes.
  static Base plane(const glm::dvec3& point_m, const glm::dvec3& normal);
  static Base sphere(const glm::dvec3& centre_m, double radius_m);
  static Base ellipsoid(const glm::dvec3& centre_m, const glm::dvec3& semi_axes_m,
                        const glm::dmat3& axes = glm::dmat3(1.0));
  // Makes the base whose height is `f` divided by the length of its gradient at a point. `f` is positive above the
  // surface. Throws also if the gradient is 0 there, or the matrix is not symmetric.
  static Base quadric(const Quadratic& f, const glm::dvec3& anchor_m);

  Kind kind() const { return kind_; }

  // Returns the centre of a sphere or an ellipsoid, the point of a plane, and the centre of a quadric's polynomial.
  const glm::dvec3& centre_m() const { return first_.centre_m; }

  // Returns the height above the base in metres, negative below. Its error is at most 1e-15 times the largest
  // length (of the point from the centre, and of the semi-axes), for quadrics 1e-15 times the sum of the terms.
  double height_m(const glm::dvec3& p_m) const;

  // Returns the derivatives of the height: where it grows, and by how many metres a metre. 0 at the centre of a
  // sphere or an ellipsoid.
  glm::dvec3 gradient(const glm::dvec3& p_m) const;

  // Returns an interval that holds the heights of all points of a box, rounding included. Heights within 1e-6 radii of
  // the centre of an ellipsoid count as those at 1e-6 radii.
  Interval bounds_m(const Box& box) const;

  // Return the polynomials whose values n1 and n2 the height is a function of. Only ellipsoids have a second one.
  const Quadratic& first() const { return first_; }
  const Quadratic& second() const { return second_; }

  // Return the height for values of the polynomials: n1; sqrt(n1) - R; sqrt(n1) (1 - 1 / sqrt(n2)).
  double height_of(double n1, double n2) const;
  Interval height_of(const Interval& n1, const Interval& n2) const;

  // Holds the values of the polynomials at a place of a ray, and half of their derivatives along it.
  struct Along {
    double n1 = 0;
    double half1 = 0;
    double n2 = 0;
    double half2 = 0;
  };

  // Returns the derivative of the height along a ray at a place of it.
  double slope_of(const Along& at) const;

  // Returns an interval that holds the derivatives of the height along a straight ray from `at` to `to`, which lie `ds`
  // apart in the ray's parameter. But for rounding it is exact for all bases other than ellipsoids.
  Interval slope_of(const Along& at, const Along& to, double ds) const;

 private:
  Kind kind_ = Kind::kPlane;
  Quadratic first_;
  Quadratic second_;
  double radius_m_ = 0;
};

}  // namespace relief
