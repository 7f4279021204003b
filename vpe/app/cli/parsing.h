// Parsers of values and files named on the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::app {

// Returns true if the file begins as SQLite files do, so that it may be a planet file.
bool is_sqlite(const std::string& path);

// Parses "LON,LAT" in degrees, east and north positive. Returns nullopt for text of any other form; does not
// check ranges (mars::is_valid does).
std::optional<mars::LonLat> parse_place(const std::string& text);

// Parses finite numbers separated by commas. Returns nullopt if any is malformed.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

}  // namespace vpe::app
