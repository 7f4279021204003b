// Parsers of values and files named on the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::app {

// Returns true if the file begins as SQLite files do, so that it may be a planet file.
bool is_sqlite(const std::string& path);

// Parses a place in any notation of mars/geodesy/place_text.h. Throws UsageError that begins with `where` and
// quotes the text.
mars::LonLat parse_place(const std::string& text, const std::string& where);

// Parses finite numbers separated by commas. Returns nullopt if any is malformed.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

}  // namespace vpe::app
