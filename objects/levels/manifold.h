// The triangles of any mesh as surfaces with at most two triangles at an edge, which is what decimation takes.
//
// Typical usage:
//   const Manifold surface = make_manifold(mesh);
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

struct Manifold {
  std::vector<glm::uvec3> triangles;       // of nodes
  std::vector<std::uint32_t> triangle_of;  // the mesh's triangle of each
  std::vector<std::uint32_t> vertex_of;    // a vertex of the mesh at the position of each node
};

// Returns the triangles of a mesh with nodes in place of vertices. Triangles are connected at an edge if they
// are the only two there and run along it in opposite directions; of more, those that continue each other best.
// Each node is in one fan of triangles, open or closed; what cannot be so gets nodes of its own. Only triangles
// with two corners at one position are left out. Pure.
Manifold make_manifold(const Mesh& mesh);

}  // namespace objects
