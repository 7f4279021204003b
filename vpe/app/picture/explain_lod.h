// Why every tile of an image has its level of detail, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Of the image that a renderer with as much memory draws of the request, complete: the same options go
// through the same selection. Numbers that are not finite are null.
nlohmann::json explain_lod(const core::DrawRequest& request, const paging::PlanetFile& planet,
                           std::size_t memory_bytes);

}  // namespace vpe::app
