// Fits an appearance to a planet: replaces what it leaves to the planet's file.
#pragma once

#include <vector>

#include "paging/planet/planet_meta.h"
#include "vpe/core/appearance/appearance.h"

namespace paging {

// Returns true if the sources of imagery are known as photographs with their own light, all of them; false if there are none.
bool have_own_light(const std::vector<mars::SourceInfo>& image_sources);

// Replaces what an appearance leaves to the planet: what core::for_body() replaces by its body, and Light::kAuto by its
// imagery (core::resolve_light()). Renderers call it before they draw. A second call changes nothing.
void fit_to_planet(vpe::core::Appearance& appearance, const PlanetMeta& meta);

}  // namespace paging
