// Reliefs over a source of elevation.
//
// Typical usage:
//   Relief relief = place(read_relief_file(path), planet_radius_m, ground_of(source));
//   auto changed = with_relief(source, std::move(relief), relief_info(path, relief.placed().size()));
#pragma once

#include <filesystem>
#include <memory>

#include "mars/sources/source.h"
#include "relief/relief.h"

namespace relief {

// Returns the ground of a source at the spacing of its finest posts at each direction. It keeps the source alive.
GroundHeight ground_of(std::shared_ptr<const mars::ElevationSource> source);

// Returns what a planet file records about a file of reliefs: name, size, time and stamp, that it is an illustration, and
// that so many formulas change the sources before it.
mars::SourceInfo relief_info(const std::filesystem::path& file, std::size_t reliefs);

// Returns the source with its heights changed by reliefs.
//
// - Heights: those of `below` at the same spacing, changed. Nodata stays nodata in every mode: a relief needs ground.
// - infos(): those of `below`, then `info`, with the datum of `below` and the finest spacing of the reliefs.
// - origin: `info` where a relief changes the height with a weight above 1/2, else that of `below`.
// - spacing_in(): the least of `below` and of the reliefs that touch the cap; infinity where `below` has no data.
// - Posts: those of `below` where no relief changes the height. Means: those of `below`, changed.
// - Its boundary of data is that of `below`.
std::shared_ptr<const mars::ElevationSource> with_relief(std::shared_ptr<const mars::ElevationSource> below,
                                                         Relief relief, mars::SourceInfo info);

}  // namespace relief
