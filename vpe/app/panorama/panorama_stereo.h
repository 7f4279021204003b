// What a panorama of two eyes needs before it is drawn: that it can be, and how far apart the eyes are.
#pragma once

#include <memory>

#include "paging/surface/surface.h"
#include "vpe/app/panorama/panorama_recipe.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Options that one eye has and two have not. Throws UsageError.
void check_stereo_panorama(const StereoArguments& arguments, const PanoramaRecipe& recipe);

// The pair for `arguments`, whose layout is not empty. Draws the panorama from the middle with about a third of
// a degree a pixel for the range of the nearest ground. `request` has settings, sun and interest. Throws
// std::runtime_error for sky alone without a base, for eyes too far apart, and what the renderer throws.
panorama::EyePair measure_eyes(const StereoArguments& arguments, const PanoramaRecipe& recipe, double radius_m,
                               const core::DrawRequest& request, core::Renderer& renderer);

// Throws std::runtime_error when an eye is less than clearance_m above the ground at one of 720 azimuths.
void require_eyes_above_ground(const PanoramaRecipe& recipe, const paging::Surface& surface,
                               double clearance_m);

}  // namespace vpe::app
