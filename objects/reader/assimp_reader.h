// Reading of models by means of assimp, inside vpe-model-reader. Points alone are read without it (ply_points.h).
//
// Typical usage:
//   const MeshStream model = read_with_assimp("rover.glb", {.unit_m = 1});
#pragma once

#include <filesystem>

#include "objects/files/mesh_stream.h"
#include "objects/files/model_file.h"

namespace objects {

// Returns a model's mesh and notes; the mesh passes check(), or check_points() where points are allowed and it has no
// triangle. Throws Refusal. Whoever calls it must be ready for faults
// of assimp, which end the process.
MeshStream read_with_assimp(const std::filesystem::path& path, const ModelFileOptions& options);

}  // namespace objects
