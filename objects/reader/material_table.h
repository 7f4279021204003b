// Materials and textures of a model as assimp found them.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/reader/gltf_file.h"
#include "objects/reader/model_folder.h"

struct aiMaterial;
struct aiScene;

namespace objects {

enum class ModelFormat : std::uint8_t { kGltf, kObj, kPly, kStl };

// Returns a channel of a colour that a file gives as 0 to 1; glTF has linear light there, other formats have sRGB.
std::uint8_t stored_channel(float value, bool is_linear);

class MaterialTable {
 public:
  // What the vertices of a part have.
  enum class Colours : std::uint8_t { kNone, kOpaque, kClear };

  struct Entry {
    std::uint16_t index = 0;
    bool has_texture = false;
  };

  // All must outlive it. `beside` are the files of materials (.mtl) that were opened.
  MaterialTable(const aiScene& scene, ModelFormat format, const ModelFolder& folder,
                const std::vector<GltfTextureUse>& uses, const std::vector<std::filesystem::path>& beside);

  // Returns the set of texture coordinates and their map that a material of assimp's needs.
  GltfTextureUse use(unsigned material) const;
  // Returns whether the material has a texture that is kept.
  bool wants_texture(unsigned material) const;
  // Returns the entry of a material for parts with and without texture coordinates. Loads its texture. Throws Refusal
  // with the name of a texture that cannot be read.
  Entry entry(unsigned material, bool has_uvs, Colours colours);
  // Adds a line for each kind of map that is not kept.
  void note_ignored(std::vector<std::string>& notes) const;

  // Moves the materials and textures into the mesh.
  void take(Mesh& mesh);

 private:
  std::string texture_name(const aiMaterial& material) const;
  int texture(const std::string& name);
  std::filesystem::path texture_path(const std::string& name) const;
  Material converted(const aiMaterial& material, bool has_texture, Colours colours) const;

  const aiScene& scene_;
  ModelFormat format_;
  const ModelFolder& folder_;
  const std::vector<GltfTextureUse>& uses_;
  std::vector<std::filesystem::path> beside_;
  std::set<std::string> coloured_;  // names of OBJ materials that have a line Kd
  std::map<std::tuple<unsigned, bool, Colours>, Entry> entries_;
  std::map<std::string, int> texture_indices_;
  std::size_t texels_ = 0;
  std::vector<Material> materials_;
  std::vector<Texture> textures_;
};

}  // namespace objects
