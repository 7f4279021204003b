// A planet file as a page for people: one HTML file that needs no other.
#pragma once

#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

// Returns the HTML of a planet's page: what it states, a map, levels, sources, accuracy, and histograms of slopes and
// elevations. `named` is the file's path as it is shown. Equal planet files under one path give equal pages. Keeps about half
// of common.memory_mb of tiles. Shows its progress on stderr. Throws paging::PlanetError, paging::DatabaseError.
std::string planet_page(const std::shared_ptr<const paging::PlanetFile>& planet, const std::string& named,
                        const Common& common);

}  // namespace vpe::app
