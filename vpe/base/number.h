// Numbers as text, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::base {

// The whole text as a finite decimal number; a leading + is allowed. Nothing for anything else: empty text,
// spaces, trailing characters, hexadecimal, inf, nan, and numbers that a double cannot hold.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

// The shortest text that parse_number() reads back to the same bits; without exponent between 1e-6 and 1e16.
// "nan", "inf" or "-inf" for what is not finite.
std::string format_number(double value);

}  // namespace vpe::base
