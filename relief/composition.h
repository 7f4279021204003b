// Composition: how a shape and a weight change ground that is there already.
//
// The target T is the shape's height above its zero level, the weight w is 0 to 1, h is the ground before:
//   add      h + w T                  (T counts from the ground)
//   replace  h + w (T - h)
//   max      h + w max(0, T - h)
//   min      h + w min(0, T - h)
// A weight of 0 leaves the ground as it is to the bit. Shapes are composed in order: each changes what those before left.
#pragma once

#include <cstdint>

#include "relief/shape.h"

namespace relief {

enum class Mode : std::uint8_t { kAdd, kReplace, kMax, kMin };

// Returns the height of the changed ground. `weight` must be 0 to 1. It ascends with the ground and with the target.
double composed_m(Mode mode, double ground_m, double target_m, double weight);

// Returns an interval that holds the results for all numbers of the intervals, which must be finite. It shrinks to the
// result as they shrink to numbers.
Interval composed_m(Mode mode, const Interval& ground_m, const Interval& target_m, const Interval& weight);

}  // namespace relief
