// The size of a model without its levels of detail.
#pragma once

#include "objects/files/scene_file.h"
#include "objects/model/mesh.h"

namespace vpe::app {

// Reads a model of triangles or of sticks, and returns a ball around it, metres in the model's frame. Any thread may call it.
// Throws what objects::read_model_file() and objects::read_stick_file() throw.
objects::Ball model_ball(const objects::ModelEntry& model);

}  // namespace vpe::app
