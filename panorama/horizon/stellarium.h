// A skyline as a landscape of Stellarium: a folder with landscape.ini and the list of points that it names.
//
// Keys and values are those that Stellarium's Landscape.cpp reads. It names the list polygonal_horizon_list.
// Comments in the list begin with #. Altitudes of places are whole metres. What lies below minimal_altitude (-2
// degrees by default) is not taken for ground.
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

// Returns lines of "azimuth elevation" in degrees. The points go once round the horizon.
std::string stellarium_list(std::span<const GroundPoint> skyline);

// Returns the content of landscape.ini. Line ends in names become spaces.
std::string stellarium_ini(const StellariumPlace& place, std::span<const GroundPoint> skyline);

}  // namespace panorama
