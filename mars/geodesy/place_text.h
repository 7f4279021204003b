// Text of places: reads coordinates in the notations of maps and papers, and writes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mars/geodesy/sphere.h"

namespace mars {

inline constexpr std::size_t kLongestPlaceText = 200;

// Parses two coordinates in degrees. Without letters the longitude comes first. These texts all mean the same
// place:
//   137.4417, -4.5895       137.4417 E 4.5895 S       4.5895 S, 222.5583 W       lat -4.5895 lon -222.5583
//   137 26 30.12, -4 35 22.2                  S 4° 35' 22.2" E 137° 26' 30.12"   137,4417; -4,5895
// - Longitude: east-positive from -360 to 360, or from 0 to 360 with E or W. Latitude: -90 to 90,
//   planetocentric.
// - Degrees, minutes and seconds stand in this order. Only the last number may have a fraction; minutes and
//   seconds are below 60.
// - A comma or semicolon separates the coordinates. If there is a semicolon, a comma between digits is a
//   decimal comma.
// - A sign together with a letter is rejected, since it is ambiguous; so are numbers without letters and units
//   of which only one coordinate has minutes ("10 20, 30").
// - Two numbers with a comma between them may have exponents.
// Returns the longitude in (-180, 180]. For other texts returns nullopt and sets `fault` to what was expected.
// Pure.
std::optional<LonLat> parse_place(std::string_view text, std::string& fault);

enum class Axis : std::uint8_t { kLongitude, kLatitude };

// Parses one coordinate in the same notations: "222.5583 W" is a longitude of 137.4417. Returns nullopt and sets
// `fault` to what was expected, also for a letter of the other axis. Pure.
std::optional<double> parse_coordinate(std::string_view text, Axis axis, std::string& fault);

// Returns a place for display: "74.200000° W (285.800000° E), 13.500000° S". parse_place() reads the part
// outside of the brackets to 5e-7 degrees.
std::string place_text(LonLat place);

}  // namespace mars
