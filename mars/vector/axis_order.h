// Selects which coordinate of a file is the latitude.
#pragma once

#include <cstdint>

namespace mars {

// Selects the order of coordinates in geographic systems that count longitudes to the west, such as IAU_2015:49901:
// programs write these in either order. by_contents: the coordinate that leaves [-90, 90] is the longitude; where none
// does it is an error. It has no effect on other systems, whose order GDAL knows.
enum class AxisOrder : std::uint8_t { by_contents, lon_first, lat_first };

}  // namespace mars
