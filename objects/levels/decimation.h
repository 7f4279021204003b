// A mesh with fewer and fewer triangles, by collapses of edges in the order of their quadrics (Garland and
// Heckbert 1997). OpenMesh keeps the connections.
//
// Typical usage:
//   Decimation decimation(mesh);
//   decimation.reduce_to(1000);
//   const Mesh coarse = decimation.mesh();
#pragma once

#include <cstddef>
#include <memory>

#include "objects/model/mesh.h"

namespace objects {

// Not for several threads at once. The same on every machine.
class Decimation {
 public:
  // Any mesh that passes check() will do, also one that is no surface (manifold.h). The mesh must stay while
  // this lives.
  explicit Decimation(const Mesh& mesh);
  ~Decimation();
  Decimation(const Decimation&) = delete;
  Decimation& operator=(const Decimation&) = delete;

  // Collapses edges until at most so many triangles are left, or no edge can be.
  void reduce_to(std::size_t triangles);
  std::size_t triangles() const;

  // Returns what is left, without triangles that have no area, and without normals and textures. Vertices are a
  // part of those of the mesh, at the same positions. Triangles keep their materials. Each corner has the
  // texture coordinates and the colour of a vertex of the mesh: borders between materials and seams of texture
  // coordinates stay where they are until little else is left; from then on a corner that moves across one
  // keeps what it had.
  Mesh mesh() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace objects
