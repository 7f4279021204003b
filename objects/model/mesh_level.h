// A level of detail of a mesh.
#pragma once

#include "objects/model/mesh.h"
#include "objects/model/triangle_tree.h"

namespace objects {

// Holds a mesh whose surface and that of level 0 lie within geometric_error_m of each other everywhere (Hausdorff distance, a
// bound).
struct MeshLevel {
  Mesh mesh;
  TriangleTree tree;
  double geometric_error_m = 0;
};

}  // namespace objects
