// Converts a DrawRequest to SelectOptions. Shared by the renderers and `--explain-lod`, so both use the same
// options. Pure.
#pragma once

#include <cstdint>

#include "lod/select.h"
#include "vpe/core/frame.h"

namespace lod {

// Returns the weights of what a budget takes.
DegradeWeights degrade_weights(const vpe::core::SettingsValues& settings);

// Returns the level control of a request.
LevelControl level_control(const vpe::core::DrawRequest& request, double planet_radius_m);

// Returns the options of a request. most_triangles (> 0) is the number that the renderer can hold; the
// request's own limit counts if it is smaller.
SelectOptions select_options(const vpe::core::DrawRequest& request, double planet_radius_m,
                             std::int64_t most_triangles);

}  // namespace lod
