// Levels of detail of models, kept in the user's cache: making them takes seconds for large models.
//
// Typical usage:
//   const std::vector<objects::Model::Level> levels = cached_levels(std::move(mesh), cache_folder() / "models");
#pragma once

#include <filesystem>
#include <vector>

#include "objects/scene/model.h"

namespace vpe::app {

// Models with fewer triangles are quicker to simplify than to look up.
inline constexpr std::size_t kLeastCachedTriangles = 20'000;

// Returns what objects::make_levels() returns. Takes the coarse levels of large meshes from a file of the folder, whose
// name is a digest of the mesh, or makes and keeps them there. A damaged file is made again; a folder that cannot be
// written is left alone.
std::vector<objects::Model::Level> cached_levels(objects::Mesh mesh, const std::filesystem::path& folder);

}  // namespace vpe::app
