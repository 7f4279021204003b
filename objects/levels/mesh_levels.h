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

// Returns the mesh as level 0 and coarser ones, each with its tree: by decimation (decimation.h), and for models
// of many parts also by leaving parts out (mesh_parts.h) and by clusters of vertices (clustering.h), whichever has
// the least error for its triangles. The error of each is a bound of the Hausdorff distance between its triangles
// and those of level 0 that have an area, and those of the level before it (hausdorff.h), so that neither a level
// nor a change to the next one shows more; it is at least a millionth of the radius of the mesh's ball. Errors
// grow from level to level: a level that is as good as a finer one replaces it, except level 0. None exceeds the
// radius. Coarse levels have normals if the mesh has (normals.h), and no textures: their materials name those of
// level 0. The mesh must pass check(). Throws std::invalid_argument for a ratio outside (0, 1). Pure; the same on
// every machine.
std::vector<MeshLevel> make_levels(Mesh mesh, const LevelOptions& options = {});

}  // namespace objects
