// Small files of models for tests: a box of 1 x 2 x 3 units in each format, and pieces of glTF.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "objects/model/mesh.h"

namespace objects::test_support {

using Json = nlohmann::json;

inline constexpr glm::vec3 kBox{1, 2, 3};  // from the origin, along the axes of the file

void write_text(const std::filesystem::path& path, std::string_view text);

// The box with outward faces. The OBJ names box.mtl unless `with_materials` is false.
std::string box_obj(bool with_materials);
std::string box_ply(bool is_binary);
std::string box_stl(bool is_binary);

// A document with one scene of one node, which shows mesh 0: the box, without normals. The buffer is inside.
Json box_gltf();
// The document as a GLB, with its buffer as the second chunk.
std::string glb_of(Json document);

// A document that shows a square of side 1 in the plane z = 0, whose texture coordinates are (x, 1 - y), with a texture
// in the file `image`.
Json square_gltf(const std::string& image);

// A PNG of 2 x 2: red and green above, blue and half-clear white below.
std::vector<std::uint8_t> four_colours_png();
// The same with another size written into its header.
std::vector<std::uint8_t> png_that_claims(std::uint32_t width, std::uint32_t height);

std::string base64(std::string_view bytes);
inline std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

// Returns the volume that the triangles enclose; negative where they face inwards.
double volume_m3(const Mesh& mesh);
// Returns the corners of the box around the vertices.
struct Bounds {
  glm::vec3 low;
  glm::vec3 high;
};
Bounds bounds_of(const Mesh& mesh);
// Returns the index of the vertex nearest to a place.
std::size_t vertex_at(const Mesh& mesh, const glm::vec3& place);

}  // namespace objects::test_support
