// The measured part of heights, where a planet has synthetic detail.
#pragma once

#include <span>
#include <vector>

#include "paging/planet/planet_meta.h"
#include "paging/surface/query.h"

namespace vpe::app {

// Returns the source that decides an answer, or null where none is known.
const mars::SourceInfo* source_of(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta);

// Returns "measured" or "synthetic" by the source that decides an answer, or null where there is no data.
const char* kind_of(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta);

// Returns the measured part of the elevation of each answer, in metres above the planet's datum: all of it where the
// deciding source is data; the carried data where that is the detail of the embedded Mars (mars/embedded); the
// elevation less the detail where that was put below other data (mars/embedded/detail_below.h), to within what straight
// facets between posts change of it. NaN where other made-up sources decide, at nodata, and where the carried data are
// missing.
std::vector<double> measured_parts_m(std::span<const paging::PlaceAnswer> answers,
                                     const paging::PlanetMeta& meta);

}  // namespace vpe::app
