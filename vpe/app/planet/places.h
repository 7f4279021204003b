// Places on the command line and on standard input.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::app {

struct PlanetAndPlaces {
  std::string planet;  // empty: the embedded Mars
  std::vector<mars::LonLat> places;
};

// Splits the arguments [PLANET] LON,LAT...: the first one is a planet unless it is a place. Throws UsageError.
PlanetAndPlaces split_places(const std::vector<std::string>& arguments);

// Reads one place per line. Skips a header, empty lines, and lines that begin with #. Throws UsageError that
// names the line.
std::vector<mars::LonLat> read_places(std::istream& in);

}  // namespace vpe::app
