// glTF files before assimp sees them: what could end assimp or would be read wrongly is refused, and what a model does
// not keep is left out.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "objects/reader/model_folder.h"
#include "objects/reader/model_streams.h"

namespace objects {

// How a material's texture lies on its triangles: set of texture coordinates, and the map of KHR_texture_transform.
struct GltfTextureUse {
  int uv_set = 0;
  glm::dvec2 offset{0, 0};
  double rotation_rad = 0;
  glm::dvec2 scale{1, 1};
};

struct GltfFile {
  Replacement replacement;                // of the file's first bytes
  std::vector<GltfTextureUse> materials;  // assimp gets the name of each: its index
  std::vector<std::string> notes;
};

// Reads the JSON of a .gltf or .glb. Throws Refusal for what is damaged (nodes in circles, arrays beyond their buffers,
// texture names outside of the folder), for compression and for other extensions that a reader must know.
GltfFile prepare_gltf(const ModelFolder& folder);

}  // namespace objects
