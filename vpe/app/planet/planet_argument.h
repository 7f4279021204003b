// PLANET on the command line: a planet file, any DEM, or nothing for the embedded Mars.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

// Returns $XDG_CACHE_HOME/vpe or ~/.cache/vpe, and makes the folder unless it exists. Throws std::runtime_error
// when neither variable is set, or when the folder cannot be made.
std::filesystem::path cache_folder();

// Returns the path of the embedded Mars in the cache, whether it is built yet or not. Throws like
// cache_folder().
std::filesystem::path embedded_planet_path();

// Returns true if open_planet() takes the argument for a raster: it is not empty, does not end in ".vpe", and the
// file, if there is one, is not a planet file.
bool is_raster_argument(const std::string& argument);

// Opens a planet file. Where the argument is a DEM or empty, this first builds a planet file into the cache,
// unless the cache has one of the same files in the same state; concurrent calls, also of other processes, wait
// for the one that builds. A planet in the cache is read without writing there. Throws what building and
// paging::PlanetFile::open() throw.
std::shared_ptr<const paging::PlanetFile> open_planet(const std::string& argument, const Common& common);

// Returns the embedded Mars with posts 21 km apart and imagery of 10 km, for a first view while build_embedded_planet()
// runs: the one that came with the program (coarse-mars.vpe), or else one that is built into the cache in a few seconds.
// Returns null if the complete one is in the cache. Throws what building
// throws.
std::shared_ptr<const paging::PlanetFile> coarse_embedded_planet(const Common& common);

// Opens the embedded Mars as open_planet("") does, without messages and for any thread; it leaves one core to others.
// Tells the share of the building that is done. Returns null once a stop was requested; the next call continues.
std::shared_ptr<const paging::PlanetFile> build_embedded_planet(const Common& common, std::stop_token stop,
                                                                const std::function<void(double)>& tell);

// Prints a note on stderr, unless quiet, when some of the planet is made up: which of its numbers are data.
void note_illustration(const paging::PlanetMeta& meta, bool quiet);

}  // namespace vpe::app
