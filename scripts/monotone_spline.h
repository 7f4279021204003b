// A smooth curve through numbers at given times that never overshoots them.
#pragma once

#include <vector>

namespace scripts {

// Piecewise cubic Hermite with the slopes of Fritsch & Butland (1984; PCHIP): continuous with its slope, and
// between two knots monotone and within their values, to the bit. Two knots give a straight line.
class MonotoneSpline {
 public:
  // Same number of times (strictly ascending) and finite values, at least one.
  MonotoneSpline(std::vector<double> times_s, std::vector<double> values);

  // The first and last value outside the times. Exact at the knots.
  double at(double time_s) const;

 private:
  std::vector<double> times_s_;
  std::vector<double> values_;
  std::vector<double> slopes_;  // per second, at the knots
};

}  // namespace scripts
