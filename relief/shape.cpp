#include "relief/shape.h"

#include <algorithm>

namespace relief {

Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval sum(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }

bool overlap(const Rect& a, const Rect& b) {
  return a.x0_m <= b.x1_m && b.x0_m <= a.x1_m && a.y0_m <= b.y1_m && b.y0_m <= a.y1_m;
}

}  // namespace relief
