// Files beside a model that it consists of: buffers and textures of glTF, materials and textures of OBJ.
#pragma once

#include <filesystem>
#include <vector>

namespace objects {

// Returns the files that a model file names and that exist, by their names in ascending order. Looks for names only: the
// model may not be read for other reasons. Names that lead out of the model's folder are left out, as the reader refuses
// them. Returns none for a file that cannot be read, or is no glTF or OBJ.
std::vector<std::filesystem::path> model_references(const std::filesystem::path& model);

}  // namespace objects
