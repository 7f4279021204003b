// The area of a tile on the unit sphere.
#pragma once

#include "lod/tree/tile_key.h"

namespace vpe::app {

// Returns the solid angle of a tile, in steradians, to about 1e-15. Pure.
double tile_area_sr(const lod::TileKey& key);

}  // namespace vpe::app
