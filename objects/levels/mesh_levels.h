// Levels of detail of a mesh, each with a bound of its error that is measured, not estimated.
//
// Typical usage:
//   std::vector<MeshLevel> levels = make_levels(std::move(mesh));
//   const Model model("rover", std::move(levels));
#pragma once

#include <cstddef>
#include <vector>

#include "objects/model/mesh_level.h"

namespace objects {

struct LevelOptions {
  double ratio = 0.25;               // triangles of a level over those of the finer one; in (0, 1)
  std::size_t least_triangles = 12;  // no level is reduced further
};

// Returns the mesh as level 0 and coarser ones by decimation (decimation.h), each with its tree. The error of
// each is a bound of the Hausdorff distance between its triangles and those of level 0 that have an area
// (hausdorff.h), and at least a millionth of the radius of the mesh's ball. Errors grow from level to level: a
// level that is as good as a finer one replaces it, except level 0. None exceeds the radius. Coarse levels have
// normals if the mesh has (normals.h), and no textures: their materials name those of level 0. The mesh must
// pass check(). Throws std::invalid_argument for a ratio outside (0, 1). Pure; the same on every machine.
std::vector<MeshLevel> make_levels(Mesh mesh, const LevelOptions& options = {});

}  // namespace objects
