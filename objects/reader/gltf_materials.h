// Materials of glTF files before assimp sees them.
#pragma once

#include <string>
#include <vector>

#include "objects/reader/gltf_file.h"
#include "objects/reader/gltf_json.h"

namespace objects {

// Adds to `kept` what gives materials their base colours: materials, textures, samplers and images. Gives `uses` an entry
// for each material. Throws Refusal for damage, for textures of other formats than PNG and JPEG, and for their names
// outside of the folder.
void keep_materials(const Json& document, const ModelFolder& folder, Json& kept,
                    std::vector<GltfTextureUse>& uses, std::vector<std::string>& notes);

}  // namespace objects
