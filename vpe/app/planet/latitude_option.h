// --latitude: the kind of latitudes of places on the command line and on standard input.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/latitude.h"
#include "mars/geodesy/sphere.h"
#include "paging/planet/planet_meta.h"

namespace vpe::app {

// Adds --latitude: "planetocentric" (the default), "planetographic", or "planetographic:EQUATORIAL_M,POLAR_M".
void add_latitude_option(CLI::App& command, std::string& text);

// Returns the ellipsoid of the given latitudes: that of the option, else of the planet's vertical datum, else of its
// body; nullopt for planetocentric latitudes. Throws UsageError where no ellipsoid is known. `option` is a text that
// --latitude accepts, or "".
std::optional<mars::Spheroid> spheroid_of_places(const std::string& option, const paging::PlanetMeta& meta);

// Makes the latitudes of places planetocentric. Without the option, notes on stderr, unless quiet, that latitudes
// are taken for planetocentric ones on a planet whose products often have others: where its datum is an ellipsoid,
// and on the Earth.
void make_planetocentric(std::vector<mars::LonLat>& places, const std::string& option,
                         const paging::PlanetMeta& meta, bool quiet);
mars::LonLat planetocentric(mars::LonLat place, const std::string& option, const paging::PlanetMeta& meta,
                            bool quiet);

}  // namespace vpe::app
