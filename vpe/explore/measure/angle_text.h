// Angles and metres for display: no sign on zero, no heading of 360.
#pragma once

#include <string>

namespace vpe::explore {

// Returns an angle with this many decimals; a value that rounds to zero has no sign: "-12.5", "0.0". Pure.
std::string angle_text(double angle_deg, int decimals);

// Returns a heading from 0 to below 360, clockwise from north, also after rounding: 359.96 with one decimal is "0.0".
// Pure.
std::string heading_text(double heading_deg, int decimals);

}  // namespace vpe::explore
