// Derives what a build needs from its options and sources before it makes the first tile.
#pragma once

#include <string>
#include <vector>

#include "paging/build/builder.h"
#include "paging/plan/build_plan.h"

namespace paging {

// Returns meta as far as it is known before the build: body, shape, sources, quantum, fill. `image` may be
// null. The fill is the mean height of the sources unless it is given. Throws PlanetError when there is no source.
PlanetMeta describe_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                           const mars::ImageSource* image, std::optional<double> fill_m = {});

// Returns the build fingerprint: everything that the content of a planet file is a function of, as lines of text, and
// paths and times of the sources. Equal fingerprints make equal tiles.
std::string build_fingerprint(const BuildOptions& options, const PlanetMeta& described);

// Returns what the content of a tile depends on beside the sources and what meta says of the planet, as lines of text:
// version and options. It is PlanetMeta::build_settings. Spacings and regions only say which tiles there are.
std::string build_settings(const BuildOptions& options);

// Returns the line that the fingerprint of a build from a finished planet has besides. Tiles of the file at `identity`
// stand in its partial file, so no other build may continue it.
std::string patch_line(const std::string& identity);

// Returns the last line of the fingerprint of a divided build. The lines before it are those of the undivided
// one.
std::string fingerprint_line(const vpe::base::Shard& shard);

// Returns a treatment in which sources are named without their folders. `meta` names the sources.
std::string without_folders(std::string treatment, const PlanetMeta& meta);

// Returns a fingerprint without the paths and times of sources whose content it has: that of copies is the same.
std::string portable_fingerprint(const std::string& fingerprint);

// Returns in what two portable fingerprints differ, for people: "mesh ratio is 128, not 256". `meta`, of the first
// one, names the sources.
std::vector<std::string> fingerprint_differences(const std::string& is, const std::string& not_this,
                                                 const PlanetMeta& meta);

// Returns the step of stored heights that fits the sources: a power of two well below what they resolve.
double choose_quantum(const std::vector<mars::SourceInfo>& sources, double finest_spacing_m);

// Returns the wanted post spacing as a function of the place. Both arguments must outlive the function.
WantedSpacing wanted_elevation(const BuildOptions& options, const mars::ElevationSource& source);

// Returns the tiles of each layer of the image, coarsest first; empty if it has no layers. `image` may be null. A layer has
// no tiles that the image does not have.
std::vector<std::vector<lod::TileKey>> plan_layers(const BuildOptions& options, const mars::ImageSource* image);

// Returns the image's tiles, coarsest first.
std::vector<lod::TileKey> plan_images(const BuildOptions& options, const mars::ImageSource& image);

}  // namespace paging
