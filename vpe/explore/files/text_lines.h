// Parsing of small text files that people edit: lines, words, numbers, and errors with line numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/flight.h"

namespace vpe::explore {

// "FILE:LINE: expected ..."; scripts::to_string() makes the text.
using LineError = scripts::FlightError;

// Returns the lines without line ends (LF or CRLF) and without a byte order mark. A last line without a line
// end counts.
std::vector<std::string_view> lines_of(std::string_view text);

// Splits a line at blanks; `#` starts a comment. A word in double quotes may contain blanks and `#`; inside, a
// backslash keeps the next character as it is. If a quote is wrong, returns no words and sets `fault` to what
// was expected.
std::vector<std::string> split_words(std::string_view line, std::string& fault);

// Returns the text as one word that split_words() reads back, with quotes if needed.
std::string as_word(std::string_view text);

// Parses a number within limits, both included. Otherwise returns nullopt and sets `fault` to what was
// expected.
std::optional<double> number_word(std::string_view word, std::string_view what, double min, double max,
                                  std::string& fault);

// Returns true if the text contains no line ends and no other control characters.
bool is_one_line(std::string_view text);

}  // namespace vpe::explore
