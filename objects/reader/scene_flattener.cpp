#include "objects/reader/scene_flattener.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <assimp/mesh.h>
#include <assimp/scene.h>
#pragma GCC diagnostic pop

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "objects/reader/mesh_builder.h"
#include "objects/reader/refusal.h"

namespace objects {

namespace {

constexpr std::size_t kMostTreeLevels = 1000 + 10;  // assimp adds its own above those of a file
constexpr std::size_t kMostNodes = 10'000'000;
constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();

struct Instance {
  const aiMesh* mesh = nullptr;
  glm::dmat4 to_model{1};
};

glm::dmat4 matrix_of(const aiMatrix4x4& m) {
  // Of rows; those of glm are of columns.
  return glm::dmat4(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4,
                    m.d4);
}

glm::dvec3 vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

std::vector<Instance> instances_of(const aiScene& scene, const glm::dmat4& to_model) {
  struct Visit {
    const aiNode* node;
    glm::dmat4 to_model;
    std::size_t level;
  };
  std::vector<Instance> instances;
  std::vector<Visit> open;
  if (scene.mRootNode != nullptr) open.push_back({scene.mRootNode, to_model, 1});
  std::size_t nodes = 0;
  std::uint64_t triangles = 0;
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    if (visit.level > kMostTreeLevels || ++nodes > kMostNodes)
      throw Refusal("it has too many nodes", "join its parts");
    const aiNode& node = *visit.node;
    const glm::dmat4 own = visit.to_model * matrix_of(node.mTransformation);
    for (unsigned n = 0; n < node.mNumMeshes; ++n) {
      if (node.mMeshes[n] >= scene.mNumMeshes) throw Refusal("a node of it names a part beyond the last one");
      instances.push_back({scene.mMeshes[node.mMeshes[n]], own});
      triangles += instances.back().mesh->mNumFaces;
      if (triangles > MeshLimits::kMostTriangles)
        throw Refusal("it has more than " + std::to_string(MeshLimits::kMostTriangles) +
                          " triangles with all copies of its parts",
                      "simplify the model");
    }
    for (unsigned n = 0; n < node.mNumChildren; ++n) open.push_back({node.mChildren[n], own, visit.level + 1});
  }
  return instances;
}

// The inverse transpose but for a positive factor, also where a transform is flat.
glm::dmat3 normals_matrix(const glm::dmat3& m, bool mirrors) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return mirrors ? -cofactors : cofactors;
}

bool is_direction(const glm::dvec3& v) {
  const double length = glm::length(v);
  return std::isfinite(length) && length > 0;
}

// glTF: the row at the top is v = 0, as here, but assimp turns it; OBJ and PLY have v = 0 at the bottom.
glm::vec2 uv_of(const aiVector3D& stored, const GltfTextureUse& use) {
  const glm::dvec2 uv(stored.x, 1.0 - static_cast<double>(stored.y));
  const glm::dvec2 scaled = use.scale * uv;
  const double c = std::cos(use.rotation_rad);
  const double s = std::sin(use.rotation_rad);
  return {glm::dvec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y) + use.offset};
}

class Flattener {
 public:
  Flattener(ModelFormat format, MaterialTable& materials, MeshBuilder::Parts parts)
      : format_(format), materials_(materials), parts_(parts), builder_(parts) {}

  void add(const Instance& instance);
  Mesh take() { return builder_.take(); }

  std::size_t points_and_lines = 0;
  std::size_t repaired_normals = 0;
  std::size_t parts_without_uvs = 0;

 private:
  ModelFormat format_;
  MaterialTable& materials_;
  MeshBuilder::Parts parts_;
  MeshBuilder builder_;
};

MaterialTable::Colours colours_of(const aiMesh& mesh, bool keeps_alpha) {
  if (!mesh.HasVertexColors(0)) return MaterialTable::Colours::kNone;
  for (unsigned n = 0; keeps_alpha && n < mesh.mNumVertices; ++n)
    if (stored_channel(mesh.mColors[0][n].a, false) < 255) return MaterialTable::Colours::kClear;
  return MaterialTable::Colours::kOpaque;
}

// Colours of three channels come with an alpha of 0.
bool is_all_clear(const aiMesh& mesh) {
  for (unsigned n = 0; n < mesh.mNumVertices; ++n)
    if (mesh.mColors[0][n].a > 0) return false;
  return true;
}

void Flattener::add(const Instance& instance) {
  const aiMesh& mesh = *instance.mesh;
  const bool is_gltf = format_ == ModelFormat::kGltf;
  const GltfTextureUse use = materials_.use(mesh.mMaterialIndex);
  const bool has_uvs = mesh.HasTextureCoords(static_cast<unsigned>(use.uv_set));
  if (materials_.wants_texture(mesh.mMaterialIndex) && !has_uvs) ++parts_without_uvs;
  const MaterialTable::Colours colours = colours_of(mesh, format_ == ModelFormat::kPly);
  const MaterialTable::Entry material = materials_.entry(mesh.mMaterialIndex, has_uvs, colours);
  const bool has_normals = parts_.normals && mesh.HasNormals();
  const bool drops_alpha = colours != MaterialTable::Colours::kNone && is_gltf && is_all_clear(mesh);
  const glm::dmat3 linear(instance.to_model);
  const bool mirrors = glm::determinant(linear) < 0;
  const glm::dmat3 for_normals = normals_matrix(linear, mirrors);

  const auto position = [&](unsigned n) {
    return glm::vec3(instance.to_model * glm::dvec4(vector_of(mesh.mVertices[n]), 1));
  };
  const auto vertex = [&](unsigned n, const glm::vec3& position_m, const glm::dvec3& normal) {
    Vertex v;
    v.position_m = position_m;
    v.normal = normal;
    if (material.has_texture) v.uv = uv_of(mesh.mTextureCoords[use.uv_set][n], use);
    if (colours != MaterialTable::Colours::kNone) {
      const aiColor4D& c = mesh.mColors[0][n];
      v.colour = {stored_channel(c.r, is_gltf), stored_channel(c.g, is_gltf), stored_channel(c.b, is_gltf),
                  drops_alpha ? std::uint8_t{255} : stored_channel(c.a, false)};
    }
    return builder_.vertex(v);
  };

  std::vector<std::uint32_t> known(mesh.mNumVertices, kUnknown);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) {
      ++points_and_lines;
      continue;
    }
    std::array<unsigned, 3> corners = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (mirrors) std::swap(corners[1], corners[2]);
    std::array<glm::vec3, 3> positions;
    for (std::size_t n = 0; n < 3; ++n) positions[n] = position(corners[n]);
    if (positions[0] == positions[1] || positions[1] == positions[2] || positions[2] == positions[0]) continue;
    const glm::dvec3 across =
        glm::cross(glm::dvec3(positions[1] - positions[0]), glm::dvec3(positions[2] - positions[0]));
    const glm::dvec3 flat = is_direction(across) ? glm::normalize(across) : glm::dvec3(0, 0, 1);
    glm::uvec3 indices{};
    for (std::size_t n = 0; n < 3; ++n) {
      const unsigned corner = corners[n];
      std::uint32_t& index = known[corner];
      if (index == kUnknown) {
        glm::dvec3 normal = flat;
        bool is_shared = !parts_.normals;
        if (has_normals) {
          const glm::dvec3 moved = for_normals * vector_of(mesh.mNormals[corner]);
          is_shared = is_direction(moved);
          if (is_shared)
            normal = glm::normalize(moved);
          else
            ++repaired_normals;
        }
        const std::uint32_t made = vertex(corner, positions[n], normal);
        if (is_shared) index = made;
        indices[static_cast<glm::length_t>(n)] = made;
      } else {
        indices[static_cast<glm::length_t>(n)] = index;
      }
    }
    builder_.triangle(indices, material.index);
  }
}

}  // namespace

void check_indices(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned n = 0; n < mesh.mFaces[f].mNumIndices; ++n)
        if (mesh.mFaces[f].mIndices[n] >= mesh.mNumVertices)
          throw Refusal("triangle " + std::to_string(f) + " names a vertex beyond the last one");
  }
}

Mesh flatten(const aiScene& scene, const glm::dmat4& to_model, ModelFormat format, MaterialTable& materials,
             std::vector<std::string>& notes) {
  const std::vector<Instance> instances = instances_of(scene, to_model);
  MeshBuilder::Parts parts;
  for (const Instance& instance : instances) {
    const aiMesh& mesh = *instance.mesh;
    // Normals of STL are those of flat triangles, and often wrong.
    parts.normals = parts.normals || (mesh.HasNormals() && format != ModelFormat::kStl);
    parts.colours = parts.colours || mesh.HasVertexColors(0);
    parts.uvs =
        parts.uvs || (materials.wants_texture(mesh.mMaterialIndex) &&
                      mesh.HasTextureCoords(static_cast<unsigned>(materials.use(mesh.mMaterialIndex).uv_set)));
  }
  Flattener flattener(format, materials, parts);
  for (const Instance& instance : instances) flattener.add(instance);
  if (flattener.points_and_lines > 0)
    notes.push_back(ignored_note(flattener.points_and_lines, "point or line", "points or lines"));
  if (flattener.repaired_normals > 0)
    notes.push_back(std::to_string(flattener.repaired_normals) +
                    (flattener.repaired_normals == 1 ? " normal" : " normals") +
                    " without a direction replaced");
  if (flattener.parts_without_uvs > 0)
    notes.push_back("textures are ignored in " + std::to_string(flattener.parts_without_uvs) +
                    (flattener.parts_without_uvs == 1 ? " part" : " parts") + " without texture coordinates");
  Mesh mesh = flattener.take();
  materials.take(mesh);
  return mesh;
}

}  // namespace objects
