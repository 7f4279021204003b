// Places of Mars by their names: of the list that comes with the program, or of a gazetteer file.
#pragma once

#include <string>
#include <vector>

#include "vpe/core/appearance/gazetteer.h"

namespace vpe::app {

// Returns the places of a gazetteer file (core::read_gazetteer()), or of the program's list if `file` is empty, the best
// known first. Throws std::runtime_error if the program's list is not there, and what core::read_gazetteer() throws.
std::vector<core::Place> read_places_of(const std::string& file);

// Returns the place of the program's list that has a name, or the only one that the search finds. Throws UsageError that
// names the option and the names that come near, and std::runtime_error if the list is not there.
core::Place place_named(const std::string& option, const std::string& name);

// Returns whether a text is meant as a name: it begins with a letter that begins no notation of coordinates. Pure.
bool looks_like_name(const std::string& text);

// Describes from where a place is seen whole: south of it, at a height above the ground, looking north and down.
struct SightOfPlace {
  double lon_deg = 0;
  double lat_deg = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double height_m = 0;
};
// Returns that sight for a field of view of some 50 degrees. Places without a diameter are taken to be 20 km wide. Pure.
SightOfPlace sight_of(const core::Place& place, double planet_radius_m);

}  // namespace vpe::app
