// Numbers as text, independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::base {

// Return the value of a text that is a finite decimal number as a whole; a leading + is allowed. Return nullopt
// for anything else: empty text, spaces, trailing characters, hexadecimal, inf, nan, and numbers that the type
// cannot hold.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

// Returns the shortest text that parse_number() reads back to the same bits, without an exponent between 1e-6
// and 1e16. Returns "nan", "inf" or "-inf" for a value that is not finite. Use it in texts for people.
std::string format_number(double value);

// Returns the shortest text that parse_number() reads back to the same bits, with an exponent where that is
// shorter: "3e+06". Use it in identifiers that must not change; use format_number() in texts for people.
std::string format_shortest(double value);

// Returns the number with this many decimals, as printf's "%.*f" does in the "C" locale: "-0.00" keeps its
// sign.
std::string format_fixed(double value, int decimals);

// Returns the number with at most this many significant digits, as printf's "%.*g" does in the "C" locale.
std::string format_general(double value, int digits);

// Returns the number rounded to at most this many decimals, without trailing zeros: "12.5", "0.35".
std::string format_rounded(double value, int decimals);

// Returns the number rounded to at most this many significant digits (at least 1), without trailing zeros, and
// without an exponent where format_number() has none: "41710", "0.092".
std::string format_significant(double value, int digits);

// Returns the number for display, with this many decimals: "-12.50". A value that rounds to zero has no sign.
// Numbers of 1e15 and more get an exponent. Returns "nan", "inf" or "-inf" for a value that is not finite.
std::string format_display(double value, int decimals);

}  // namespace vpe::base
