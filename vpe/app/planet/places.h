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

// [PLANET] LON,LAT...: the first argument is a planet unless it is a place. Throws UsageError.
PlanetAndPlaces split_places(const std::vector<std::string>& arguments);

// A place a line; a header, empty lines and lines that begin with # are skipped. Throws UsageError with the
// line.
std::vector<mars::LonLat> read_places(std::istream& in);

}  // namespace vpe::app
