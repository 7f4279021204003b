// The text of a polygon: "LON,LAT;LON,LAT;LON,LAT".
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace relief {

// Returns the corners of a text, none for "". Sets `problem` to what is wrong, and returns none then; else to "".
std::vector<mars::LonLat> parse_polygon(std::string_view text, std::string& problem);

// Returns the text from which parse_polygon() reads the same corners to the bit.
std::string format_polygon(std::span<const mars::LonLat> corners);

}  // namespace relief
