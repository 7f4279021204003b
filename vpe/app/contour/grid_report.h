// Reports what commands say about ground that they have sampled on a grid, and the files of lines that they write.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "mars/vector/feature_writer.h"
#include "paging/planet/planet_file.h"
#include "vpe/app/cli/progress.h"
#include "vpe/map/ground_grid.h"

namespace vpe::app {

struct Common;

// Samples the surface with half of the command's memory for tiles. Shows progress, and ends when the user
// interrupts.
map::GroundGrid sample_with_progress(const std::shared_ptr<const paging::PlanetFile>& planet,
                                     const map::GridFrame& frame, const Common& common, ProgressLine& line);

// Returns the grid, the datum, the resolution, the known errors, the sources and the shares of gaps and of
// synthetic ground.
nlohmann::json grid_json(const map::GridFrame& frame, const map::MapGround& ground,
                         const paging::PlanetMeta& meta);

// Returns the same as lines for people, each with a line break.
std::string grid_text(const map::GridFrame& frame, const map::MapGround& ground,
                      const paging::PlanetMeta& meta);

// Returns what a file of features says about itself: `what`, then the same in sentences.
mars::FeatureFileInfo feature_info(const std::string& what, const map::GridFrame& frame,
                                   const map::MapGround& ground, const paging::PlanetMeta& meta);

}  // namespace vpe::app
