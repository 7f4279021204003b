// Fits how a cost grows: y = c x^p, as a straight line through the logarithms.
#pragma once

#include <span>

namespace vpe::report {

struct Growth {
  double exponent = 0;
  double half_width = 0;  // exponent +- this holds the true one with 95 %: Student's t over the residuals
  double factor = 0;      // y at x = 1
  double residual = 0;    // standard deviation of ln y about the line
  int points = 0;
};

// Fits ln y over ln x by least squares. half_width is infinite for two points. Throws std::invalid_argument for
// fewer than two points, for fewer than two different x, and for values that are not finite and positive.
Growth fit_growth(std::span<const double> x, std::span<const double> y);

}  // namespace vpe::report
