#include "relief/composition.h"

#include <algorithm>
#include <cmath>

#include "relief/interval_math.h"

namespace relief {

double composed_m(Mode mode, double ground_m, double target_m, double weight) {
  if (weight == 0) return ground_m;
  switch (mode) {
    case Mode::kAdd: return ground_m + weight * target_m;
    case Mode::kReplace: break;
    case Mode::kMax:
      if (target_m <= ground_m) return ground_m;
      break;
    case Mode::kMin:
      if (target_m >= ground_m) return ground_m;
      break;
  }
  return weight == 1 ? target_m : ground_m + weight * (target_m - ground_m);
}

Interval composed_m(Mode mode, const Interval& ground_m, const Interval& target_m, const Interval& weight) {
  if (weight.high == 0) return ground_m;
  // The result is linear in the weight, so that its ends decide.
  const Interval low{composed_m(mode, ground_m.low, target_m.low, weight.low),
                     composed_m(mode, ground_m.low, target_m.low, weight.high)};
  const Interval high{composed_m(mode, ground_m.high, target_m.high, weight.low),
                      composed_m(mode, ground_m.high, target_m.high, weight.high)};
  const double size_m = std::max(
      {std::abs(ground_m.low), std::abs(ground_m.high), std::abs(target_m.low), std::abs(target_m.high)});
  return widened({std::min(low.low, low.high), std::max(high.low, high.high)}, kRounding * size_m);
}

}  // namespace relief
