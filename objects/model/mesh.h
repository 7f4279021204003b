// Triangle meshes of objects: what a model file holds, in one frame and without a hierarchy.
//
// Model frame: right-handed, metres; x to the right, y forward, z up, as the axes of a camera. The origin is the point
// that stands on the ground.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "vpe/core/image/image.h"

namespace objects {

using Rgba = vpe::core::Rgba;

struct Texture {
  int width = 0;
  int height = 0;
  std::vector<Rgba> texels;  // width * height, row 0 at v = 0 (the top), sRGB with straight alpha
};

enum class AlphaMode : std::uint8_t {
  kOpaque,  // alpha is ignored
  kMask,    // hidden where alpha is below the cutoff, else opaque
  kBlend,   // semi-transparent
};

struct Material {
  Rgba colour{200, 200, 200, 255};  // sRGB, multiplied with the texture and with colours of vertices
  int texture = -1;                 // of Mesh::textures; -1: none
  AlphaMode alpha = AlphaMode::kOpaque;
  std::uint8_t cutoff = 128;  // of kMask
  bool double_sided = true;   // false: triangles are hidden from behind, where their corners run clockwise
};

// Arrays of vertices have an entry for each vertex or none at all; arrays of triangles for each triangle.
struct Mesh {
  std::vector<glm::vec3> positions_m;
  std::vector<glm::vec3> normals;  // unit; empty: each triangle is flat
  std::vector<glm::vec2> uvs;      // texture coordinates, repeating; empty: no textures
  std::vector<Rgba> colours;       // empty: white
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint16_t> materials;  // of triangles
  std::vector<Material> material_table;  // at least one
  std::vector<Texture> textures;         // empty in the levels of a Model, which has them itself

  std::size_t bytes() const;
};

// Gives the limits that check() enforces, so that no file can claim all memory.
struct MeshLimits {
  static constexpr std::size_t kMostVertices = 50'000'000;
  static constexpr std::size_t kMostTriangles = 50'000'000;
  static constexpr std::size_t kMostMaterials = 65'535;
  static constexpr std::size_t kMostTextures = 4'096;
  static constexpr std::size_t kMostTexels = std::size_t{1} << 28;  // of all textures together
  static constexpr double kMostExtent_m = 1e9;                      // of a coordinate
};

// Returns "" if the mesh can be drawn, else what is wrong with it: sizes of arrays that do not fit, indices beyond their
// arrays, coordinates that are not finite or exceed the limits, no triangle. Pure.
std::string check(const Mesh& mesh);

// Returns "" if the mesh has points, i.e. vertices with or without normals and colours, and nothing else; else what is
// wrong with it, as check() does. Normals may have any length, also 0: none. Pure.
std::string check_points(const Mesh& mesh);

// Encloses the vertices in a ball. The radius is at most 1.1 times that of the smallest one, and rounded up.
struct Ball {
  glm::vec3 centre_m{0, 0, 0};
  float radius_m = 0;
};
Ball bounding_ball(const Mesh& mesh);

}  // namespace objects
