#include "vpe/base/number_range.h"

#include <cmath>

#include "vpe/base/number.h"

namespace vpe::base {

bool is_within(double value, const NumberRange& range) {
  if (!std::isfinite(value)) return false;
  return value <= range.most && (range.is_open ? value > range.least : value >= range.least);
}

std::string range_text(const NumberRange& range) {
  return std::string("a number in ") + (range.is_open ? "(" : "[") + format_number(range.least) + ", " +
         format_number(range.most) + "]";
}

}  // namespace vpe::base
