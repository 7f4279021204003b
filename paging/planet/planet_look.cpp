#include "paging/planet/planet_look.h"

#include <algorithm>
#include <utility>

#include "paging/planet/planet_file.h"
#include "vpe/core/appearance/image_layers.h"
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

std::string layers_problem(const std::string& image_layers, const PlanetMeta& meta) {
  const auto& there = meta.image_layers;
  for (const vpe::core::ImageLayerLook& look : vpe::core::parse_image_layers(image_layers)) {
    if (there.empty())
      return "it has no image layers, so '" + look.name +
             "' cannot be shown; build the planet with --images-apart, or leave image.layers out";
    if (std::ranges::find(there, look.name, &ImageLayer::name) != there.end()) continue;
    std::string names;
    for (const ImageLayer& layer : there) names += (names.empty() ? "" : ", ") + layer.name;
    return "it has no image layer '" + look.name + "'; its layers are " + names;
  }
  return {};
}

std::shared_ptr<const PlanetFile> with_layers_of(const std::shared_ptr<const PlanetFile>& planet,
                                                 const std::string& image_layers) {
  if (image_layers.empty() && planet->shown_layers().empty()) return planet;
  return planet->with_images(vpe::core::parse_image_layers(image_layers));
}

std::shared_ptr<const PlanetFile> keep_layers(std::shared_ptr<const PlanetFile> next,
                                              const std::shared_ptr<const PlanetFile>& shown) {
  return next->is_same_file(*shown) ? next->with_images(shown->shown_layers(), shown) : std::move(next);
}

}  // namespace paging
