// What a build finds out of its options and sources before it makes the first tile.
#pragma once

#include <string>
#include <vector>

#include "paging/build/build_plan.h"
#include "paging/build/builder.h"

namespace paging {

// Meta as far as it is known before the build: body, shape, sources, quantum, fill. Throws PlanetError when
// there is no source. image may be null.
PlanetMeta describe_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                           const mars::ImageSource* image);

// Everything that a planet file's content is a function of, as text: equal recipes make equal tiles.
std::string recipe_of(const BuildOptions& options, const PlanetMeta& described);

// Its last line where a build is divided; the rest is that of the undivided build.
std::string recipe_part(const vpe::base::Shard& part);

// Both arguments must outlive the function.
WantedSpacing wanted_elevation(const BuildOptions& options, const mars::ElevationSource& source);

// The image's tiles, coarsest first.
std::vector<lod::TileKey> plan_images(const BuildOptions& options, const mars::ImageSource& image);

}  // namespace paging
