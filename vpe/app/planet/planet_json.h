// A planet file's description as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "paging/planet/planet_meta.h"

namespace vpe::app {

// Returns what `vpe info --json` and `vpe build --json` print about a planet file. `by_level` counts levels
// from 0; `levels` is their number.
nlohmann::json planet_json(const paging::PlanetMeta& meta);

}  // namespace vpe::app
