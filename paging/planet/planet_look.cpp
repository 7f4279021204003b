#include "paging/planet/planet_look.h"

#include <algorithm>

#include "vpe/core/appearance/light_choice.h"
#include "vpe/core/appearance/sky.h"

namespace paging {

// One unknown source, such as a global mosaic of albedo below a photograph, needs the light.
bool have_own_light(const std::vector<mars::SourceInfo>& image_sources) {
  return !image_sources.empty() && std::ranges::all_of(image_sources, &mars::SourceInfo::has_own_light);
}

void fit_to_planet(vpe::core::Appearance& appearance, const PlanetMeta& meta) {
  vpe::core::for_body(appearance, meta.body);
  vpe::core::resolve_light(appearance, meta.finest_image_level >= 0 && have_own_light(meta.image_sources));
}

}  // namespace paging
