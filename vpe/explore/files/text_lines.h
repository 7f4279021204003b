// Small text files that people edit: lines, words, numbers, and what is wrong with them by line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/flight.h"

namespace vpe::explore {

// FILE:LINE: expected ...; scripts::to_string() makes the text.
using LineError = scripts::FlightError;

// Without their ends (LF or CRLF) and without a byte order mark. A last line without an end counts.
std::vector<std::string_view> lines_of(std::string_view text);

// Words split by blanks; `#` starts a comment. A word in double quotes may hold blanks and `#`; inside, a
// backslash keeps the next character as it is. `fault` says what was expected where a quote is wrong (then
// there are no words).
std::vector<std::string> split_words(std::string_view line, std::string& fault);

// The text as one word that split_words() reads back, in quotes where it needs them.
std::string as_word(std::string_view text);

// A number within limits, both allowed; otherwise nothing, and `fault` says what was expected.
std::optional<double> number_word(std::string_view word, std::string_view what, double min, double max,
                                  std::string& fault);

// What was found, in quotes, cut short and fit for a terminal whatever bytes it holds.
std::string found_text(std::string_view text);

// No line ends and no other control characters.
bool is_one_line(std::string_view text);

}  // namespace vpe::explore
