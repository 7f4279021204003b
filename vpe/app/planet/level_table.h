// The content of a planet file level by level, for people.
#pragma once

#include <string>

#include "paging/planet/planet_meta.h"

namespace vpe::app {

// Prints a table with a row for each level: posts, tiles, image tiles, size, nodata and resampling error.
void print_level_table(const paging::PlanetMeta& meta);

// Returns the resampling error as "RMS 1.2 m, maximum 34 m (4000000 source posts)".
std::string resampling_text(const paging::ResamplingError& resampling);

// Returns the finest level with a resampling error of its own, or nullptr if the planet has less than two such
// levels. Where a part of the planet is built finely, the error of the whole planet is mostly that of the
// coarse rest.
const paging::LevelSummary* finest_measured(const paging::PlanetMeta& meta);

}  // namespace vpe::app
