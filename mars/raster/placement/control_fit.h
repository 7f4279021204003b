// Checks how well ground control points agree with a polynomial: residuals, without GDAL.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>

namespace mars {

struct ControlPoint {
  glm::dvec2 pixel{0};   // (0, 0) is the outer corner of the first pixel
  glm::dvec2 ground{0};  // in the units of the points' coordinate system
  std::string name;
};

// Returns the number of coefficients of each coordinate, which is the least number of points: 3, 6 or 10 for the
// orders 1, 2 and 3.
std::size_t polynomial_terms(int order);

struct Misfit {
  double rms_px = 0;
  double largest_px = 0;
  std::size_t worst = 0;  // number of the point that has it
};

struct PolynomialCheck {
  Misfit fitted;  // of the least-squares fit to all points
  std::optional<Misfit>
      left_out;  // of each point from the fit to all others; nullopt if a fit needs every point
};

// Fits pixels as polynomials of the ground by least squares. Returns nullopt if there are too few points, or if they
// do not determine the polynomial: all on one line, or, for higher orders, on one curve of that order.
std::optional<PolynomialCheck> check_polynomial(std::span<const ControlPoint> points, int order);

// Points lie on one line if their spread across it is less than this share of that along it.
inline constexpr double kLeastSpread = 0.01;

// Returns true if all pixels or all places on the ground lie on one line, or if there are less than 3 points.
bool are_on_one_line(std::span<const ControlPoint> points);

}  // namespace mars
