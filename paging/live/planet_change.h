// The change from the ground of a planet to that of another: a second epoch.
//
// Typical usage:
//   const auto after = planet_change(*before, PlanetFile::open("after.vpe"));
//   const MadePatch made = PatchMaker(before).make(*partial_change(after, 0.5));
#pragma once

#include <memory>

#include "paging/live/ground_change.h"
#include "paging/planet/planet_file.h"

namespace paging {

// Returns the change that makes the ground of `from` that of `to`, within the rounding of heights. It touches the finest
// tiles of `from` whose posts or nodata are others in `to`, which it finds by reading all of them. Where `to` has no data,
// the ground stays. Throws PlanetError, naming both files, for planets of another body, radius, shape or datum, and where a
// tile cannot be read. Keeps about `budget_bytes` of `to`. Smaller: tiles are read again more often.
std::shared_ptr<const GroundChange> planet_change(const PlanetFile& from, std::shared_ptr<const PlanetFile> to,
                                                  std::size_t budget_bytes = std::size_t{32} << 20);

}  // namespace paging
