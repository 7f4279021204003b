// Checks the heights of sources before they become posts of a planet, and their files afterwards.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "mars/sources/source.h"
#include "paging/planet/planet_meta.h"

namespace paging {

// Reports sources from which no planet can be built as they are. Tiles that were made of them are of no use.
class UnusableSource : public PlanetError {
 public:
  using PlanetError::PlanetError;
};

// Smallest distance of a post from the planet's centre, as a share of the planet's radius. The inverse of the
// distance, in which meshes are flat, is then finite and has all its digits.
inline constexpr double kLeastRadius = 1e-3;

// Throws UnusableSource unless every height can be stored in steps of meta.quantum_m and lies at least
// kLeastRadius above the planet's centre. Ignores nodata, i.e. heights that are not finite. The message names the file and the place.
void check_heights(std::span<const glm::dvec3> directions, std::span<const double> heights_m,
                   const PlanetMeta& meta, const mars::ElevationSource& elevation);

// Throws UnusableSource if a file of one of the sources has changed since it was opened: the tiles are of both
// versions.
void check_files(std::span<const mars::SourceInfo> sources);

}  // namespace paging
