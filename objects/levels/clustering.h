// A mesh with fewer vertices, those of each cell of a grid in one place (Rossignac and Borrel 1993), which is where its planes
// meet best (Lindstrom 2000). It joins what decimation keeps apart, as it does not look at connections.
//
// Typical usage:
//   const Mesh coarse = cluster(mesh, 0.1);
#pragma once

#include "objects/model/mesh.h"

namespace objects {

// Returns the triangles of a mesh whose corners lie in three different cells of cell_m, with the corners at their cells'
// places. A place lies in its cell. Of triangles that fall together the one of the largest area stays, for each side if the
// material is not double-sided. Triangles keep their materials, and corners their texture coordinates and colours. Normals,
// textures and triangles without area are left out. cell_m must be above 0, and so large that the mesh has less than 2^20
// cells along an axis; else the result is the mesh itself. Pure; the same on every machine.
Mesh cluster(const Mesh& mesh, double cell_m);

}  // namespace objects
