// PLANET on the command line: a planet file, any DEM, or nothing for the embedded Mars.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

// $XDG_CACHE_HOME/vpe or ~/.cache/vpe; made when missing. Throws when there is neither, or it cannot be made.
std::filesystem::path cache_folder();

// Where the embedded Mars is, once it is built. Throws as cache_folder().
std::filesystem::path embedded_planet_path();

// Opens a planet file; builds one into the cache first, once, where the argument is a DEM or empty. Concurrent
// calls wait for the one that builds.
std::shared_ptr<const paging::PlanetFile> open_planet(const std::string& argument, const Common& common);

}  // namespace vpe::app
