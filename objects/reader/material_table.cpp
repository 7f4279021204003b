#include "objects/reader/material_table.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "objects/reader/refusal.h"
#include "objects/reader/texture_image.h"
#include "vpe/base/file.h"
#include "vpe/base/quote.h"

namespace objects {

namespace fs = std::filesystem;

namespace {

std::string name_of(const aiMaterial& material) {
  aiString name;
  return material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS ? name.C_Str() : "";
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// assimp gives materials without a line Kd a grey of its own.
std::set<std::string> names_with_colour(const std::vector<fs::path>& files) {
  constexpr std::uintmax_t kMostMtl_bytes = 64 << 20;
  std::set<std::string> names;
  for (const fs::path& file : files) {
    const std::vector<std::uint8_t> bytes = vpe::base::read_file(file, kMostMtl_bytes);
    std::istringstream lines(std::string(bytes.begin(), bytes.end()));
    std::string material;
    for (std::string line; std::getline(lines, line);) {
      line = trimmed(line);
      if (line.starts_with("newmtl")) material = trimmed(line.substr(6));
      if (line.starts_with("Kd") || line.starts_with("kd")) names.insert(material);
    }
  }
  return names;
}

std::string texture_of(const aiMaterial& material, aiTextureType type) {
  aiString name;
  return material.GetTexture(type, 0, &name) == aiReturn_SUCCESS ? name.C_Str() : "";
}

}  // namespace

std::uint8_t stored_channel(float value, bool is_linear) {
  if (!(value > 0)) return 0;
  double x = std::min(static_cast<double>(value), 1.0);
  if (is_linear) x = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * x));
}

MaterialTable::MaterialTable(const aiScene& scene, ModelFormat format, const ModelFolder& folder,
                             const std::vector<GltfTextureUse>& uses, const std::vector<fs::path>& beside)
    : scene_(scene), format_(format), folder_(folder), uses_(uses) {
  if (format != ModelFormat::kObj) return;
  beside_ = beside;
  coloured_ = names_with_colour(beside_);
}

GltfTextureUse MaterialTable::use(unsigned material) const {
  if (format_ != ModelFormat::kGltf || material >= scene_.mNumMaterials) return {};
  const std::string name = name_of(*scene_.mMaterials[material]);
  std::size_t index = uses_.size();
  std::from_chars(name.data(), name.data() + name.size(), index);
  return !name.empty() && index < uses_.size() ? uses_[index] : GltfTextureUse{};
}

std::string MaterialTable::texture_name(const aiMaterial& material) const {
  std::string name = texture_of(material, aiTextureType_DIFFUSE);
  if (name.empty()) name = texture_of(material, aiTextureType_BASE_COLOR);
  // Files of Windows.
  if (format_ == ModelFormat::kObj) std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

bool MaterialTable::wants_texture(unsigned material) const {
  return material < scene_.mNumMaterials && !texture_name(*scene_.mMaterials[material]).empty();
}

MaterialTable::Entry MaterialTable::entry(unsigned material, bool has_uvs, Colours colours) {
  const bool has_texture = has_uvs && wants_texture(material);
  const auto key = std::tuple(material, has_texture, colours);
  if (const auto found = entries_.find(key); found != entries_.end()) return found->second;
  static const aiMaterial kNoMaterial;
  const aiMaterial& source = material < scene_.mNumMaterials ? *scene_.mMaterials[material] : kNoMaterial;
  if (materials_.size() >= MeshLimits::kMostMaterials)
    throw Refusal("it has more than " + std::to_string(MeshLimits::kMostMaterials) + " materials",
                  "join its materials");
  Material result = converted(source, has_texture, colours);
  if (has_texture) result.texture = texture(texture_name(source));
  const Entry entry{static_cast<std::uint16_t>(materials_.size()), has_texture};
  materials_.push_back(result);
  entries_.emplace(key, entry);
  return entry;
}

Material MaterialTable::converted(const aiMaterial& source, bool has_texture, Colours colours) const {
  Material result;
  const bool is_tinted = has_texture || colours != Colours::kNone;
  if (is_tinted) result.colour = {255, 255, 255, 255};
  if (format_ == ModelFormat::kPly || format_ == ModelFormat::kStl) {
    if (colours == Colours::kClear) result.alpha = AlphaMode::kBlend;
    return result;
  }
  const bool is_linear = format_ == ModelFormat::kGltf;
  aiColor4D colour(1, 1, 1, 1);
  source.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  const auto channel = [&](float x) { return stored_channel(x, is_linear); };
  if (is_linear || coloured_.contains(name_of(source)))
    result.colour = {channel(colour.r), channel(colour.g), channel(colour.b), 255};
  if (format_ == ModelFormat::kObj) {
    float opacity = 1;
    source.Get(AI_MATKEY_OPACITY, opacity);
    result.colour.a = stored_channel(opacity, false);
    const std::string mask = texture_of(source, aiTextureType_OPACITY);
    if (result.colour.a < 255 || (has_texture && mask == texture_of(source, aiTextureType_DIFFUSE)))
      result.alpha = AlphaMode::kBlend;
    return result;
  }
  result.colour.a = stored_channel(colour.a, false);
  int is_double_sided = 0;
  source.Get(AI_MATKEY_TWOSIDED, is_double_sided);
  result.double_sided = is_double_sided != 0;
  aiString mode;
  if (source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS) {
    if (std::string(mode.C_Str()) == "MASK") result.alpha = AlphaMode::kMask;
    if (std::string(mode.C_Str()) == "BLEND") result.alpha = AlphaMode::kBlend;
  }
  float cutoff = 0.5F;
  source.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
  result.cutoff = stored_channel(cutoff, false);
  return result;
}

fs::path MaterialTable::texture_path(const std::string& name) const {
  try {
    return folder_.find(name, "texture");
  } catch (const Refusal&) {
    // Names may be meant relative to the file of materials.
    for (const fs::path& file : beside_) {
      const fs::path below = fs::relative(file.parent_path(), folder_.model().parent_path());
      try {
        check_relative(name, "texture");
        return folder_.find((below / name).string(), "texture");
      } catch (const Refusal&) {
        continue;
      }
    }
    throw;
  }
}

int MaterialTable::texture(const std::string& name) {
  if (const auto found = texture_indices_.find(name); found != texture_indices_.end()) return found->second;
  if (textures_.size() >= MeshLimits::kMostTextures)
    throw Refusal("it has more than " + std::to_string(MeshLimits::kMostTextures) + " textures",
                  "join its textures");
  std::vector<std::uint8_t> read;
  std::span<const std::uint8_t> bytes;
  if (const aiTexture* inside = scene_.GetEmbeddedTexture(name.c_str()); inside != nullptr) {
    if (inside->mHeight != 0 || inside->pcData == nullptr) throw Refusal("one of its textures is not read");
    bytes = {reinterpret_cast<const std::uint8_t*>(inside->pcData), inside->mWidth};
  } else {
    read = vpe::base::read_file(texture_path(name), ModelFolder::kMostBytes);
    bytes = read;
  }
  try {
    textures_.push_back(decode_texture(bytes, MeshLimits::kMostTexels - texels_));
  } catch (const Refusal& refusal) {
    throw Refusal("its texture " + vpe::base::quote_text(name) + " " + refusal.what(), refusal.advice());
  }
  texels_ += textures_.back().texels.size();
  const int index = static_cast<int>(textures_.size()) - 1;
  texture_indices_.emplace(name, index);
  return index;
}

void MaterialTable::note_ignored(std::vector<std::string>& notes) const {
  std::size_t others = 0;
  for (unsigned n = 0; n < scene_.mNumMaterials && format_ != ModelFormat::kGltf; ++n) {
    const aiMaterial& material = *scene_.mMaterials[n];
    bool has_other = false;
    for (int type = aiTextureType_NONE + 1; type <= AI_TEXTURE_TYPE_MAX; ++type) {
      const std::string name = texture_of(material, static_cast<aiTextureType>(type));
      const bool is_kept =
          type == aiTextureType_DIFFUSE || type == aiTextureType_BASE_COLOR ||
          (type == aiTextureType_OPACITY && name == texture_of(material, aiTextureType_DIFFUSE));
      has_other = has_other || (!name.empty() && !is_kept);
    }
    if (has_other) ++others;
  }
  if (others > 0)
    notes.push_back("maps other than that of the base colour are ignored in " + std::to_string(others) +
                    (others == 1 ? " material" : " materials"));
}

void MaterialTable::take(Mesh& mesh) {
  mesh.material_table = std::exchange(materials_, {});
  mesh.textures = std::exchange(textures_, {});
}

}  // namespace objects
