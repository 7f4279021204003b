// Computes what a click in an image or on a map asks of layers.
#pragma once

#include <optional>

#include "vpe/core/view.h"
#include "vpe/explore/layers/feature_pick.h"
#include "vpe/explore/measure/map_view.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

// Returns the query of a click in an image of ground, or nullopt where no ground is within reach: rays through all pixels within
// reach find how far away features can be. Places that ground hides are not seen. The query refers to `ground`. It casts about
// 3 * reach_px^2 rays.
std::optional<PickQuery> query_in_view(const TerrainQuery& ground, const core::View& view, glm::dvec2 xy,
                                       double reach_px);

// Returns the query of a click at a place of a map. Pure.
PickQuery query_on_map(const MapView& map, mars::LonLat place, double reach_px);

}  // namespace vpe::explore
