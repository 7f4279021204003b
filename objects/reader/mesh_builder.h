// Gathers triangles into one mesh whose equal vertices are one.
//
// Typical usage:
//   MeshBuilder builder({.normals = true});
//   const std::uint32_t a = builder.vertex(...);
//   builder.triangle({a, b, c}, material);
//   const Mesh mesh = builder.take();
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

struct Vertex {
  glm::vec3 position_m{0, 0, 0};
  glm::vec3 normal{0, 0, 0};
  glm::vec2 uv{0, 0};
  Rgba colour{255, 255, 255, 255};
  bool operator==(const Vertex&) const = default;
};

class MeshBuilder {
 public:
  // Says which arrays of vertices the mesh has.
  struct Parts {
    bool normals = false;
    bool uvs = false;
    bool colours = false;
  };

  explicit MeshBuilder(Parts parts) : parts_(parts) {}

  // Returns the index of a vertex that has the same numbers in all arrays of the mesh. Throws Refusal for more vertices
  // than MeshLimits allows.
  std::uint32_t vertex(const Vertex& vertex);
  void triangle(glm::uvec3 corners, std::uint16_t material);

  // Returns the mesh, without materials and textures, and leaves nothing here.
  Mesh take();

 private:
  Vertex kept(std::uint32_t index) const;
  void grow();

  Parts parts_;
  Mesh mesh_;
  std::vector<std::uint32_t> table_;  // open addressing; a power of two, at most half full
};

}  // namespace objects
