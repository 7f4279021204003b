// --box: an area by degrees.
#pragma once

#include <string>

#include "paging/planet/planet_meta.h"
#include "vpe/map/map_grid.h"

namespace vpe::app {

// Parses WEST,SOUTH,EAST,NORTH in degrees; empty text is all of the planet. A box whose east is not more than its west goes
// over the antimeridian. A name (named_places.h) is the smallest box around the circle of a feature of Mars. Throws
// UsageError, also for names of places without a diameter.
map::PlaceBox parse_box(const std::string& text);

// Returns the smallest box around a circle on the planet; a circle around a pole has all longitudes. The diameter is more
// than 0. Pure.
map::PlaceBox box_around(mars::LonLat middle, double diameter_m, double planet_radius_m);

// Throws UsageError if the box was given by a name, and the planet is not Mars.
void require_planet_of_box(const std::string& text, const paging::PlanetMeta& meta);

}  // namespace vpe::app
