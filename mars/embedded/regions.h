// Regions in which the embedded Mars has finer posts than elsewhere.
#pragma once

#include "mars/sources/source.h"

namespace mars {

// Describes a kind of region, from the coarsest to the finest.
enum class EmbeddedRegion { kPlain, kBroad, kLandmark, kDemo };

// Returns the finest kind of region that the cap touches. Conservative.
EmbeddedRegion embedded_region_in(const Cap& cap);

}  // namespace mars
