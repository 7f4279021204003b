// Range images by Embree, as a baseline of `vpe report error-time`. Built with VPE_EMBREE=ON.
#pragma once

#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Returns true if this program was built with Embree.
bool has_embree();

// Makes a renderer of ranges of the reference surface, of perspective views, without colours. It casts 16 rays
// at a time against all finest tiles with terrain that the camera may see (embree_scene.h). The first image of
// a camera builds the scene, outside of any memory budget. Its certificates state no error. Throws
// std::runtime_error with Embree's message, and if Embree is not built in.
std::unique_ptr<core::Renderer> make_embree_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                     int threads);

}  // namespace vpe::app
