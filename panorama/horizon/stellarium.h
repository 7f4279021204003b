// A skyline as a landscape of Stellarium: a folder with landscape.ini and the list of points it names.
//
// The words are those that Stellarium's Landscape.cpp reads. It calls the list polygonal_horizon_list; comments
// in the list begin with #; altitudes of places are whole metres; what lies below minimal_altitude (-2 degrees
// when left out) is not taken for ground.
#pragma once

#include <span>
#include <string>

#include "panorama/horizon/skyline.h"

namespace panorama {

inline constexpr const char* kStellariumList = "horizon.txt";

struct StellariumPlace {
  std::string name;  // of the landscape
  std::string planet;
  mars::LonLat place;
  double alt_m = 0;
};

// "azimuth elevation" a line, degrees. The points go once round.
std::string stellarium_list(std::span<const GroundPoint> skyline);

// landscape.ini. Line ends in names become spaces.
std::string stellarium_ini(const StellariumPlace& place, std::span<const GroundPoint> skyline);

}  // namespace panorama
