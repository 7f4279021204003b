// Places on standard input.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::app {

// Holds places with the further columns of their table.
struct PlaceTable {
  std::vector<mars::LonLat> places;
  std::vector<std::string> columns;             // names of the further columns; empty without a header
  std::vector<std::vector<std::string>> cells;  // of each place, as many as there are columns
};

// Reads one place a line. Skips empty lines and lines that begin with #. The first line may be a header. It
// must name one longitude (lon, longitude, lon_deg, lng, long, x) and one latitude (lat, latitude, lat_deg, y),
// in any order among other columns, whatever the case; x and y count only where no other name does. Its columns
// are separated by commas, semicolons or tabs; a field may stand in double quotes. Without a header a line is a
// place. Throws UsageError that names the line and `name`, the file's.
PlaceTable read_places(std::istream& in, const std::string& name = "standard input");

}  // namespace vpe::app
