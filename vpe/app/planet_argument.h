// PLANET on the command line: a planet file, any DEM, or nothing for the embedded Mars.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "mars/sphere.h"
#include "paging/planet_file.h"
#include "vpe/app/program.h"

namespace vpe::app {

// $XDG_CACHE_HOME/vpe or ~/.cache/vpe; made when missing. Throws when there is neither, or it cannot be made.
std::filesystem::path cache_folder();

// Where the embedded Mars is, once it is built. Throws as cache_folder().
std::filesystem::path embedded_planet_path();

// Opens a planet file; builds one into the cache first, once, where the argument is a DEM or empty. Concurrent
// calls wait for the one that builds.
std::shared_ptr<const paging::PlanetFile> open_planet(const std::string& argument, const Common& common);

// Whether a file begins as SQLite files do, and so may be a planet file.
bool is_sqlite(const std::string& path);

// "LON,LAT" with degrees east and north; nothing when the text is not of that form. Range errors are told by
// mars::is_valid.
std::optional<mars::LonLat> parse_place(const std::string& text);

// Numbers separated by commas; nothing when any is malformed.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

}  // namespace vpe::app
