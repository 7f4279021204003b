// Values as TOML.
#pragma once

#include <string>

namespace vpe::explore {

// Returns a text as a TOML string on one line. A text that TOML cannot hold (not UTF-8) becomes empty.
std::string toml_string(const std::string& text);

// Returns the shortest TOML float from which the same bits are read: "90.0", "-0.0". Expects a finite number.
std::string toml_number(double value);

}  // namespace vpe::explore
