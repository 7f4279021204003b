// Fits an appearance to a planet: replaces what it leaves to the planet's file, and shows the layers that it names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_meta.h"
#include "vpe/core/appearance/appearance.h"

namespace paging {

class PlanetFile;

// Returns true if the sources of imagery are known as photographs with their own light, all of them; false if there are none.
bool have_own_light(const std::vector<mars::SourceInfo>& image_sources);

// Replaces what an appearance leaves to the planet: what core::for_body() replaces by its body, and Light::kAuto by its
// imagery (core::resolve_light()). Renderers call it before they draw. A second call changes nothing.
void fit_to_planet(vpe::core::Appearance& appearance, const PlanetMeta& meta);

// Returns why a planet cannot show the layers of a setting image.layers: "it has no image layer 'x'; ..."; "" if it can.
// Expects a text that core::parse_image_layers() reads.
std::string layers_problem(const std::string& image_layers, const PlanetMeta& meta);

// Returns the planet with the image layers that the setting image.layers names (PlanetFile::with_images()); the planet
// itself if it shows them already. Renderers go over to it before they draw. Throws PlanetError for layers that the
// planet does not have.
std::shared_ptr<const PlanetFile> with_layers_of(const std::shared_ptr<const PlanetFile>& planet,
                                                 const std::string& image_layers);

// Returns a planet that is shown next, with the layers of the one that is shown now if both are of one file, so that pages
// of images serve on; else the planet.
std::shared_ptr<const PlanetFile> keep_layers(std::shared_ptr<const PlanetFile> next,
                                              const std::shared_ptr<const PlanetFile>& shown);

}  // namespace paging
