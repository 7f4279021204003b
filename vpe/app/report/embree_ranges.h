// Range images by Embree, as a baseline of `vpe report error-time`. Built with VPE_EMBREE=ON.
#pragma once

#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Whether this program has it.
bool has_embree();

// Draws ranges of S of perspective views, without colours: all finest tiles with ground that the camera can
// possibly see, as grids of floats relative to the camera, 16 rays at a time. The scene is built by the first
// image of a camera, outside of any memory budget. States nothing of its error. Throws std::runtime_error with
// Embree's words, and where it is not built in.
std::unique_ptr<core::Renderer> make_embree_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                     int threads);

}  // namespace vpe::app
