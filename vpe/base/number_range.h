// Ranges of numbers that a file or an option may hold.
#pragma once

#include <string>

namespace vpe::base {

struct NumberRange {
  double least;
  double most;
  bool is_open = false;  // least itself is excluded
};

// Returns true for a finite number in the range.
bool is_within(double value, const NumberRange& range);

// Returns "a number in [-90, 90]".
std::string range_text(const NumberRange& range);

}  // namespace vpe::base
