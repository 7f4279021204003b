#include "lod/tree/error_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/base/mutation.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

void ErrorTerms::include(const ErrorTerms& other) {
  height_error_m = std::max(height_error_m, other.height_error_m);
  sagitta_m = std::max(sagitta_m, other.sagitta_m);
  total_m = std::max(total_m, other.total_m);
}

double second_order_bound(double exaggeration, double range_m, double min_height_m, double max_height_m,
                          double radius_m) {
  const double x = exaggeration;
  const double low = std::min(0.0, x);
  const double high = std::max(1.0, x);
  const double a =
      radius_m + std::min({low * min_height_m, low * max_height_m, high * min_height_m, high * max_height_m});
  if (a <= 0.0) return std::numeric_limits<double>::infinity();
  if (mutated(Guard::kSecondOrder)) return 0.0;
  return std::abs(x * (x - 1.0)) * range_m * range_m * radius_m * radius_m / (4.0 * a * a * a);
}

double error_bound(const ErrorTerms& terms, double exaggeration, double min_height_m, double max_height_m,
                   double radius_m) {
  if (exaggeration == 1.0) return terms.total_m;
  return std::abs(exaggeration) * terms.height_error_m + terms.sagitta_m +
         second_order_bound(exaggeration, max_height_m - min_height_m, min_height_m, max_height_m, radius_m);
}

}  // namespace lod
