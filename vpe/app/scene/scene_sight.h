// Objects of scene files on the lines of sight that a window measures.
//
// Typical usage:
//   planet.open_scene = scene_sight(planet.surface);
#pragma once

#include <memory>

#include "paging/surface/surface.h"
#include "vpe/explore/measure/sight_scene.h"

namespace vpe::app {

// Returns a function that opens scenes on a surface without exaggeration. Nothing is read before it is called. It shares
// the models that it keeps between calls with its copies, so only one of them may be called at a time. Objects are met
// at their finest levels (objects/draw/single_ray.h), on the sides that images show, and are called by their names, or
// by those of their models. Throws what SceneLibrary::scene() throws.
vpe::explore::OpenScene scene_sight(std::shared_ptr<const paging::Surface> surface);

}  // namespace vpe::app
