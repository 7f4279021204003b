#include "objects/reader/mesh_builder.h"

#include <bit>
#include <limits>
#include <utility>

#include "objects/reader/refusal.h"

namespace objects {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Both zeros are one number.
float plain(float x) { return x + 0.0F; }

std::uint64_t hash_of(const Vertex& v) {
  std::uint64_t hash = 0x9e3779b97f4a7c15;
  const auto mix = [&](std::uint32_t word) {
    hash = (hash ^ word) * 0xff51afd7ed558ccd;
    hash ^= hash >> 32;
  };
  for (const float x :
       {v.position_m.x, v.position_m.y, v.position_m.z, v.normal.x, v.normal.y, v.normal.z, v.uv.x, v.uv.y})
    mix(std::bit_cast<std::uint32_t>(x));
  mix(std::bit_cast<std::uint32_t>(v.colour));
  return hash;
}

}  // namespace

Vertex MeshBuilder::kept(std::uint32_t index) const {
  Vertex v;
  v.position_m = mesh_.positions_m[index];
  if (parts_.normals) v.normal = mesh_.normals[index];
  if (parts_.uvs) v.uv = mesh_.uvs[index];
  if (parts_.colours) v.colour = mesh_.colours[index];
  return v;
}

void MeshBuilder::grow() {
  table_.assign(table_.empty() ? 1024 : 2 * table_.size(), kNone);
  for (std::uint32_t n = 0; n < mesh_.positions_m.size(); ++n) {
    std::size_t slot = hash_of(kept(n)) & (table_.size() - 1);
    while (table_[slot] != kNone) slot = (slot + 1) & (table_.size() - 1);
    table_[slot] = n;
  }
}

std::uint32_t MeshBuilder::vertex(const Vertex& given) {
  Vertex v;
  const auto plain3 = [](const glm::vec3& x) { return glm::vec3(plain(x.x), plain(x.y), plain(x.z)); };
  v.position_m = plain3(given.position_m);
  if (parts_.normals) v.normal = plain3(given.normal);
  if (parts_.uvs) v.uv = {plain(given.uv.x), plain(given.uv.y)};
  if (parts_.colours) v.colour = given.colour;
  if (2 * (mesh_.positions_m.size() + 1) > table_.size()) grow();
  std::size_t slot = hash_of(v) & (table_.size() - 1);
  for (; table_[slot] != kNone; slot = (slot + 1) & (table_.size() - 1))
    if (kept(table_[slot]) == v) return table_[slot];
  const auto index = static_cast<std::uint32_t>(mesh_.positions_m.size());
  if (index >= MeshLimits::kMostVertices)
    throw Refusal("it has more than " + std::to_string(MeshLimits::kMostVertices) + " vertices",
                  "simplify the model");
  table_[slot] = index;
  mesh_.positions_m.push_back(v.position_m);
  if (parts_.normals) mesh_.normals.push_back(v.normal);
  if (parts_.uvs) mesh_.uvs.push_back(v.uv);
  if (parts_.colours) mesh_.colours.push_back(v.colour);
  return index;
}

void MeshBuilder::triangle(glm::uvec3 corners, std::uint16_t material) {
  mesh_.triangles.push_back(corners);
  mesh_.materials.push_back(material);
}

Mesh MeshBuilder::take() {
  table_ = {};
  return std::exchange(mesh_, {});
}

}  // namespace objects
