// Figures as people read them: few digits, and a unit that suits. Files and JSON keep all digits.
#pragma once

#include <string>

namespace vpe::app {

// Returns a length with at most this many significant digits: "0.092 m", "163 m", and from 10 km on "3396.19 km".
std::string length_text(double metres, int digits = 4);

// Returns a size as "8.3 MB", "1.24 GB".
std::string bytes_text(double bytes);

// Returns a text of sentences with each number of more than 5 significant digits and a decimal point rounded to
// 4. Other characters, names such as "a1.234567" included, stay as they are.
std::string with_short_numbers(const std::string& text);

}  // namespace vpe::app
