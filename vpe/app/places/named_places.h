// Places of Mars by their names: of the lists that come with the program, or of a gazetteer file.
#pragma once

#include <string>
#include <vector>

#include "paging/planet/planet_meta.h"
#include "vpe/core/appearance/gazetteer.h"

namespace vpe::app {

// Returns the places of a gazetteer file (core::read_gazetteer()), the best known first. If `file` is empty,
// returns those of the program: the names of the IAU, then the landing sites (explore::read_landing_sites()),
// which are left out where their file is not there. Throws std::runtime_error if the program's names are not
// there, and what the readers throw.
std::vector<core::Place> read_places_of(const std::string& file);

// Returns the place of the program's lists that has a name, or the only one of whose name the text is a part;
// case, accents and punctuation do not count. Throws UsageError that names the option and the names that come
// near, and std::runtime_error if the lists are not there.
core::Place place_named(const std::string& option, const std::string& name);

// Returns whether a text is meant as a name: it begins with a letter and has neither digits nor commas. Pure.
bool looks_like_name(const std::string& text);

// Returns whether the program's lists have exactly this name, as "Viking 1". Reads them for texts that begin
// with a letter only. Throws what read_places_of() throws.
bool is_listed_name(const std::string& text);

// Returns whether a text is a name: it looks like one, or is in the lists.
bool is_name(const std::string& text);

// Holds what an option that takes a place was given.
struct GivenPlace {
  mars::LonLat place;     // coordinates have the latitude of --latitude, a named place has a planetocentric one
  std::string name;       // as in the list; empty: coordinates were given
  double diameter_m = 0;  // of the named place; 0: unknown
};

// Returns the place that the value of an option means. A text that reads as coordinates (mars::parse_place())
// is coordinates, whatever names there are. Any other text for which is_name() holds is a name, see
// place_named(). Throws UsageError that names the option and what was expected, and std::runtime_error if the
// lists are not there.
GivenPlace given_place(const std::string& option, const std::string& text);

struct PlanetAndPlaces {
  std::string planet;  // empty: the embedded Mars
  std::vector<GivenPlace> places;
};

// Splits the arguments [PLANET] PLACE...: the first one is a place if it is no file, but reads as coordinates
// (mars/geodesy/place_text.h) or is a whole name of the program's lists; else it is a planet. The other ones are read by
// given_place(). Throws UsageError.
PlanetAndPlaces split_places(const std::vector<std::string>& arguments);

// Returns the planetocentric place on a planet: coordinates are converted from the kind of latitude that
// `latitude` states, and without it planets are noted on stderr whose products often have other latitudes,
// unless quiet (latitude_option.h). Throws UsageError for a name on another planet than Mars, and for
// `latitude` without a known ellipsoid.
mars::LonLat place_on(const GivenPlace& given, const std::string& option, const std::string& latitude,
                      const paging::PlanetMeta& meta, bool quiet);

// Returns the planetocentric places of a command line in their order, as place_on() does, with one note at
// most.
std::vector<mars::LonLat> places_on(const std::vector<GivenPlace>& given, const std::string& latitude,
                                    const paging::PlanetMeta& meta, bool quiet);

// Throws UsageError that begins with the option and the name if a planet is not Mars: by its body, or by a
// radius that differs by more than 1 %. Pure.
void require_mars_for_name(const std::string& option, const std::string& name, const paging::PlanetMeta& meta);

// Describes from where a place is seen whole: south of it, at a height above the ground, looking north and
// down.
struct SightOfPlace {
  double lon_deg = 0;
  double lat_deg = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double height_m = 0;
};
// Returns that sight for a field of view of some 50 degrees. Places without a diameter are taken to have
// explore::ArrivalLimits::kUnknown_m. Pure.
SightOfPlace sight_of(const core::Place& place, double planet_radius_m);

}  // namespace vpe::app
