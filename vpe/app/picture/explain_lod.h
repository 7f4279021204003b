// Explanation of the level of detail of every tile of an image, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "lod/explain.h"
#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Explains the tiles of the complete image that a polygon renderer with this much memory draws for the request:
// the same options go through the same selection. Levels count from 0: the LOD numbers of Hitchner 1992 minus
// one. Numbers that are not finite are null.
nlohmann::json explain_lod(const core::DrawRequest& request, const paging::PlanetFile& planet,
                           std::size_t memory_bytes);

// Returns the same for an image by rays, of the tiles that it was cast with (RayOptions::explained).
nlohmann::json explain_lod(const core::DrawRequest& request, std::span<const lod::TileExplanation> cast);

}  // namespace vpe::app
