// Arithmetic of intervals: each result holds the results for all numbers of the operands, but for rounding.
#pragma once

#include <algorithm>

#include "relief/interval_math.h"
#include "relief/shape.h"

namespace relief {

inline double width(const Interval& a) { return a.high - a.low; }
inline double middle(const Interval& a) { return 0.5 * (a.low + a.high); }
inline bool holds(const Interval& a, double value) { return a.low <= value && value <= a.high; }

// Returns the interval of the ends in either order.
inline Interval between(double a, double b) { return a < b ? Interval{a, b} : Interval{b, a}; }

inline Interval difference(const Interval& a, const Interval& b) { return {a.low - b.high, a.high - b.low}; }

inline Interval scaled(const Interval& a, double factor) { return between(a.low * factor, a.high * factor); }

// Returns the interval of the products. An infinite end times 0 is not allowed.
inline Interval product(const Interval& a, const Interval& b) {
  const double ll = a.low * b.low;
  const double lh = a.low * b.high;
  const double hl = a.high * b.low;
  const double hh = a.high * b.high;
  return {std::min(std::min(ll, lh), std::min(hl, hh)), std::max(std::max(ll, lh), std::max(hl, hh))};
}

// Returns what is in both. The result has low > high if nothing is.
inline Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

}  // namespace relief
