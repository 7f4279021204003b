#include "objects/reader/gltf_materials.h"

#include <array>
#include <cstdlib>
#include <utility>

#include "objects/files/uri.h"
#include "objects/reader/refusal.h"

namespace objects {

namespace {

constexpr std::uint64_t kRepeat = 10497;

struct IgnoredTexture {
  const char* key;
  const char* words;
};
constexpr std::array<IgnoredTexture, 3> kIgnoredTextures = {{
    {"normalTexture", "normal maps"},
    {"occlusionTexture", "occlusion maps"},
    {"emissiveTexture", "emission maps"},
}};

const Json& object_in(const Json& object, const char* key) {
  static const Json kNone = Json::object();
  const auto found = object.find(key);
  return found != object.end() && found->is_object() ? *found : kNone;
}

GltfTextureUse use_of(const Json& texture) {
  GltfTextureUse use;
  use.uv_set = static_cast<int>(whole_of(texture, "texCoord", 7).value_or(0));
  const Json& transform = object_in(object_in(texture, "extensions"), "KHR_texture_transform");
  const auto pair = [&](const char* key, glm::dvec2& value) {
    check_numbers(transform, key, 2);
    if (transform.contains(key)) value = {transform[key][0].get<double>(), transform[key][1].get<double>()};
  };
  pair("offset", use.offset);
  pair("scale", use.scale);
  use.rotation_rad = number_of(transform, "rotation", 0);
  if (const auto set = whole_of(transform, "texCoord", 7)) use.uv_set = static_cast<int>(*set);
  return use;
}

Json kept_image(const Json& image, const Json& document, const ModelFolder& folder) {
  const auto uri = image.find("uri");
  if (uri == image.end()) {
    if (!index_of(image, "bufferView", list_of(document, "bufferViews").size()))
      throw Refusal("one of its textures has no data");
    // assimp needs a kind; the content tells it anyway.
    Json kept = picked(image, {"bufferView"});
    kept["mimeType"] = "image/png";
    return kept;
  }
  if (!uri->is_string()) throw Refusal("one of its textures has no name");
  const std::string name = decoded_uri(uri->get<std::string>());
  if (!name.starts_with("data:")) {
    static_cast<void>(folder.find(name, "texture"));
    return {{"uri", name}};
  }
  const std::size_t comma = name.find(";base64,");
  if (comma == std::string::npos || comma > 100) throw Refusal("one of its textures is not stored as base64");
  return {{"uri", "data:image/png" + name.substr(comma)}};
}

// What the old extension for specular colours says takes the place of the base colour.
Json base_of(const Json& material) {
  const Json& old = object_in(object_in(material, "extensions"), "KHR_materials_pbrSpecularGlossiness");
  if (old.empty())
    return picked(object_in(material, "pbrMetallicRoughness"), {"baseColorFactor", "baseColorTexture"});
  Json base = Json::object();
  if (old.contains("diffuseFactor")) base["baseColorFactor"] = old["diffuseFactor"];
  if (old.contains("diffuseTexture")) base["baseColorTexture"] = old["diffuseTexture"];
  return base;
}

}  // namespace

void keep_materials(const Json& document, const ModelFolder& folder, Json& kept,
                    std::vector<GltfTextureUse>& uses, std::vector<std::string>& notes) {
  const Json& textures = list_of(document, "textures");
  const Json& images = list_of(document, "images");
  const Json& samplers = list_of(document, "samplers");
  // Those that no base colour names stay as empty entries, which assimp does not read.
  kept["textures"] = Json(textures.size(), Json::object());
  kept["images"] = Json(images.size(), Json::object());
  std::array<std::size_t, kIgnoredTextures.size()> ignored{};
  std::size_t rough = 0;
  std::size_t glowing = 0;
  std::size_t unrepeated = 0;
  for (const Json& material : list_of(document, "materials")) {
    Json own = picked(material, {"alphaMode", "alphaCutoff", "doubleSided"});
    static_cast<void>(number_of(material, "alphaCutoff", 0));
    own["name"] = std::to_string(uses.size());
    Json base = base_of(material);
    check_numbers(base, "baseColorFactor", 4);
    const Json& texture_info = object_in(base, "baseColorTexture");
    uses.push_back(use_of(texture_info));
    if (base.contains("baseColorTexture")) {
      const std::optional<std::size_t> index = index_of(texture_info, "index", textures.size());
      if (!index) throw Refusal("one of its materials names no texture");
      const Json& texture = textures.at(*index);
      const std::optional<std::size_t> source = index_of(texture, "source", images.size());
      if (!source)
        throw Refusal("one of its textures is neither PNG nor JPEG", "save it with textures as PNG or JPEG");
      kept["textures"][*index] = {{"source", *source}};
      if (kept["images"][*source].empty())
        kept["images"][*source] = kept_image(images.at(*source), document, folder);
      if (const auto sampler = index_of(texture, "sampler", samplers.size())) {
        const Json& wraps = samplers.at(*sampler);
        if (whole_of(wraps, "wrapS", 65535).value_or(kRepeat) != kRepeat ||
            whole_of(wraps, "wrapT", 65535).value_or(kRepeat) != kRepeat)
          ++unrepeated;
      }
      base["baseColorTexture"] = {{"index", *index}};
    }
    own["pbrMetallicRoughness"] = base;
    kept["materials"].push_back(own);
    for (std::size_t n = 0; n < ignored.size(); ++n)
      if (material.contains(kIgnoredTextures[n].key)) ++ignored[n];
    if (object_in(material, "pbrMetallicRoughness").contains("metallicRoughnessTexture")) ++rough;
    check_numbers(material, "emissiveFactor", 3);
    if (material.contains("emissiveFactor") && material["emissiveFactor"] != Json({0, 0, 0})) ++glowing;
  }
  const auto note = [&](const std::string& words, std::size_t count) {
    if (count > 0)
      notes.push_back(words + " of " + std::to_string(count) + (count == 1 ? " material" : " materials") +
                      " are ignored");
  };
  for (std::size_t n = 0; n < ignored.size(); ++n) note(kIgnoredTextures[n].words, ignored[n]);
  note("maps of metal and roughness", rough);
  note("colours of emission", glowing);
  if (unrepeated > 0)
    notes.push_back("textures of " + std::to_string(unrepeated) +
                    (unrepeated == 1 ? " material repeat" : " materials repeat") +
                    " here, although the file ends them");
}

}  // namespace objects
