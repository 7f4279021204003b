// The parts of a mesh that are not joined with each other, as models of machines have many, and what is left without the
// small ones.
//
// Typical usage:
//   const Mesh plain = without_near_parts(mesh, 0.02);  // bolts and treads lie within 2 cm of what carries them
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

struct MeshParts {
  std::vector<std::uint32_t> of;  // the part of each triangle
  std::size_t count = 0;
};

// Returns the parts of a mesh: triangles with a common position are in one. Parts are numbered from 0 in the order of their
// first triangles. Pure.
MeshParts find_parts(const Mesh& mesh);

// Returns a mesh without the parts whose corners, and middles of triangles, all lie within a distance of larger ones that
// stay. Larger is what has more area; of equal parts that of the lower number. Normals, textures and triangles without area are
// left out. Pure; the same on every machine.
Mesh without_near_parts(const Mesh& mesh, double within_m);

}  // namespace objects
