// Computes where a panorama shows a direction, as objects/posters asks for it. Internal to vpe/app.
#pragma once

#include "objects/posters/placed_poster.h"
#include "panorama/projection.h"

namespace vpe::app {

// Returns the lookup of a map; `reduced` is the number of its pixels to one that is kept, across and down.
objects::PanoramaLookup panorama_lookup(const panorama::PanoramaMap& map, const glm::dvec2& reduced);

// Returns the formula that agrees with panorama_lookup() within 1e-8 pixels, or nullopt for an image of more than a full circle,
// which shows a direction twice.
std::optional<objects::PanoramaFormula> panorama_formula(const panorama::PanoramaMap& map);

}  // namespace vpe::app
