// A smooth curve through numbers at given times that never overshoots them.
//
// Typical usage:
//   const MonotoneSpline altitude(times_s, altitudes_m);
//   const double altitude_m = altitude.at(12.5);
#pragma once

#include <vector>

namespace scripts {

// Interpolates by piecewise cubic Hermite polynomials with the slopes of Fritsch & Butland (1984; PCHIP). The
// curve and its slope are continuous. Between two knots it is monotone and within their values, to the bit.
// Two knots give a straight line.
class MonotoneSpline {
 public:
  // Requires as many times (strictly ascending) as values (finite), at least one.
  MonotoneSpline(std::vector<double> times_s, std::vector<double> values);

  // Returns the value at a time; the first or last value outside the times. Exact at the knots.
  double at(double time_s) const;

 private:
  std::vector<double> times_s_;
  std::vector<double> values_;
  std::vector<double> slopes_;  // per second, at the knots
};

}  // namespace scripts
