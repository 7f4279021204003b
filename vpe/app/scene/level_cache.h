// Levels of detail of models, kept in the user's cache: making them takes seconds for large models.
//
// Typical usage:
//   KeptLevels made = cached_levels(std::move(mesh), cache_folder() / "models");
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "objects/scene/model.h"

namespace vpe::app {

// Models with fewer triangles are quicker to simplify than to look up.
inline constexpr std::size_t kLeastCachedTriangles = 20'000;

struct KeptLevels {
  std::vector<objects::Model::Level> levels;
  std::string note;  // why there is only the finest level; empty: levels were made
};

// Returns what objects::make_levels_apart() returns, or the finest level alone and why that failed. Takes the coarse levels
// of meshes of at least so many triangles from a file of the folder, whose name is a digest of the mesh, or makes and
// keeps them there. A damaged file is made again; a folder that cannot be written is left alone.
KeptLevels cached_levels(objects::Mesh mesh, const std::filesystem::path& folder,
                         std::size_t least_triangles = kLeastCachedTriangles);

}  // namespace vpe::app
