// From assimp's scene to one mesh.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/reader/material_table.h"

struct aiScene;

namespace objects {

// Throws Refusal where a face names a vertex beyond the last one of its part.
void check_indices(const aiScene& scene);

// Returns the mesh of all nodes of a scene, each moved by its transform and then by `to_model`. A transform that mirrors
// turns the triangles over, so that their outside stays outside. Adds lines about what was dropped or repaired. Throws
// Refusal where limits are exceeded, counted before copies are made. All indices must be checked before.
Mesh flatten(const aiScene& scene, const glm::dmat4& to_model, ModelFormat format, MaterialTable& materials,
             std::vector<std::string>& notes);

}  // namespace objects
