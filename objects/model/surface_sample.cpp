#include "objects/model/surface_sample.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace objects {

namespace {

template <class T>
T mixed(const std::vector<T>& values, const glm::uvec3& t, const glm::vec2& w) {
  return values[t.x] * (1.0F - w.x - w.y) + values[t.y] * w.x + values[t.z] * w.y;
}

glm::vec4 floats(const Rgba& c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)};
}

// Returns how far texture coordinates go for a metre of the triangle, at the mean over directions.
float uv_per_m(const Mesh& mesh, const glm::uvec3& t) {
  const glm::vec3 a = mesh.positions_m[t.y] - mesh.positions_m[t.x];
  const glm::vec3 b = mesh.positions_m[t.z] - mesh.positions_m[t.x];
  const glm::vec2 ua = mesh.uvs[t.y] - mesh.uvs[t.x];
  const glm::vec2 ub = mesh.uvs[t.z] - mesh.uvs[t.x];
  const float area_m2 = glm::length(glm::cross(a, b));
  const float area_uv = std::abs(ua.x * ub.y - ua.y * ub.x);
  return area_m2 > 0 ? std::sqrt(area_uv / area_m2) : 0.0F;
}

}  // namespace

glm::vec4 surface_colour(const Mesh& mesh, const std::vector<TexturePyramid>& textures, std::uint32_t triangle,
                         const glm::vec2& weights, float footprint_m) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const Material& material = mesh.material_table[mesh.materials[triangle]];
  glm::vec4 colour = floats(material.colour);
  if (!mesh.colours.empty()) {
    colour *= (floats(mesh.colours[t.x]) * (1.0F - weights.x - weights.y) +
               floats(mesh.colours[t.y]) * weights.x + floats(mesh.colours[t.z]) * weights.y) /
              255.0F;
  }
  if (material.texture >= 0 && !mesh.uvs.empty() && !textures.empty()) {
    const TexturePyramid& texture = textures[static_cast<std::size_t>(material.texture)];
    colour *= texture.sample(mixed(mesh.uvs, t, weights), footprint_m * uv_per_m(mesh, t)) / 255.0F;
  }
  if (material.alpha == AlphaMode::kOpaque) colour.w = 255.0F;
  if (material.alpha == AlphaMode::kMask)
    colour.w = colour.w >= static_cast<float>(material.cutoff) ? 255.0F : 0.0F;
  return colour;
}

glm::vec3 plane_normal(const Mesh& mesh, std::uint32_t triangle) {
  const glm::uvec3& t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions_m[t.x]);
  const glm::dvec3 n = glm::cross(glm::dvec3(mesh.positions_m[t.y]) - a, glm::dvec3(mesh.positions_m[t.z]) - a);
  const double length = glm::length(n);
  return length > 0 ? glm::vec3(n / length) : glm::vec3(0, 0, 1);
}

glm::vec3 surface_normal(const Mesh& mesh, std::uint32_t triangle, const glm::vec2& weights) {
  if (mesh.normals.empty()) return plane_normal(mesh, triangle);
  const glm::vec3 n = mixed(mesh.normals, mesh.triangles[triangle], weights);
  const float length = glm::length(n);
  return length > 0 ? n / length : plane_normal(mesh, triangle);
}

}  // namespace objects
