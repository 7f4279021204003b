// Places as people paste them: two coordinates in any of the ways in which maps and papers write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {

// Reads two coordinates, degrees. Without letters the longitude comes first. All of these are one place:
//   137.4417, -4.5895       137.4417 E 4.5895 S       4.5895 S, 222.5583 W       lat -4.5895 lon -222.5583
//   137 26 30.12, -4 35 22.2                  S 4° 35' 22.2" E 137° 26' 30.12"   137,4417; -4,5895
// Longitude: east-positive from -360 to 360, or from 0 to 360 with E or W; latitude from -90 to 90,
// planetocentric. Degrees, minutes and seconds stand in this order; only the last number has a fraction, and
// minutes and seconds are below 60. A comma or semicolon is between the coordinates; where there is a
// semicolon, a comma between digits is a decimal one. A sign and a letter at once are refused, as what is meant
// is not certain. Longitude comes back in (-180, 180]. Otherwise nothing, and `fault` says what was expected.
// Pure.
inline constexpr std::size_t kLongestPlaceText = 200;
std::optional<mars::LonLat> read_place(std::string_view text, std::string& fault);

// "74.200000° W (285.800000° E), 13.500000° S": what a place is, for eyes; read_place() reads the part outside
// of the brackets to 5e-7 degrees.
std::string place_words(mars::LonLat place);

}  // namespace vpe::explore
