#include "objects/reader/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string_view>

#include "objects/files/uri.h"
#include "objects/reader/gltf_json.h"
#include "objects/reader/gltf_materials.h"
#include "objects/reader/refusal.h"
#include "vpe/base/file.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

constexpr int kMostJsonLevels = 100;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBodyChunk = 0x004e4942;
constexpr std::size_t kHeader_bytes = 12;
constexpr std::size_t kChunkHeader_bytes = 8;

using Bytes = std::vector<std::uint8_t>;

std::uint32_t word_at(const Bytes& bytes, std::size_t at) {
  if (at + 4 > bytes.size()) throw Refusal("it ends early");
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

struct Container {
  bool is_binary = false;
  std::string_view json;
  std::uint64_t json_end = 0;               // the first byte that stays
  std::optional<std::uint64_t> body_bytes;  // of the buffer in a GLB
};

Container open_container(const Bytes& bytes, bool is_binary) {
  const bool has_magic = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
  if (has_magic != is_binary)
    throw Refusal(has_magic ? "it is a GLB" : "it is not a GLB", has_magic ? "name it .glb" : "check the file");
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  if (!is_binary) return {false, {text, bytes.size()}, bytes.size(), {}};
  if (word_at(bytes, 4) != 2)
    throw Refusal("its format is glTF " + std::to_string(word_at(bytes, 4)), "save it as glTF 2.0");
  const std::size_t json_bytes = word_at(bytes, kHeader_bytes);
  const std::size_t begin = kHeader_bytes + kChunkHeader_bytes;
  if (word_at(bytes, kHeader_bytes + 4) != kJsonChunk) throw Refusal("it does not begin with JSON");
  if (begin + json_bytes > bytes.size()) throw Refusal("it ends early");
  Container result{true, {text + begin, json_bytes}, begin + json_bytes, {}};
  if (result.json_end + kChunkHeader_bytes > bytes.size()) return result;
  result.body_bytes = word_at(bytes, result.json_end);
  if (word_at(bytes, result.json_end + 4) != kBodyChunk) throw Refusal("its second chunk is not its buffer");
  if (result.json_end + kChunkHeader_bytes + *result.body_bytes > bytes.size()) throw Refusal("it ends early");
  return result;
}

Json parse(std::string_view text) {
  const auto shallow = [](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
    if (depth > kMostJsonLevels) throw Refusal("its JSON is nested too deep");
    return true;
  };
  try {
    Json document = Json::parse(text.begin(), text.end(), shallow);
    if (!document.is_object()) throw Refusal("its JSON is not an object");
    return document;
  } catch (const Json::exception& error) {
    throw Refusal("its JSON is damaged: " + std::string(error.what()));
  }
}

std::set<std::string> names_of(const Json& document, const char* key) {
  std::set<std::string> names;
  const auto found = document.find(key);
  if (found == document.end() || !found->is_array()) return names;
  for (const Json& name : *found)
    if (name.is_string()) names.insert(name.get<std::string>());
  return names;
}

void check_extensions(const Json& document, std::vector<std::string>& notes) {
  const std::set<std::string> required = names_of(document, "extensionsRequired");
  std::set<std::string> all = names_of(document, "extensionsUsed");
  all.insert(required.begin(), required.end());
  for (const std::string& name : all) {
    if (name.find("compression") != std::string::npos)
      throw Refusal("it is compressed with " + vpe::base::quote_text(name) + ", which is not read",
                    "save it without compression");
    if (name == "KHR_texture_transform" || name == "KHR_materials_pbrSpecularGlossiness" ||
        name == "KHR_lights_punctual")
      continue;
    if (required.contains(name) && !name.starts_with("KHR_materials_"))
      throw Refusal("it needs the extension " + vpe::base::quote_text(name) + ", which is not read",
                    "save it without that extension");
    notes.push_back("the extension " + vpe::base::quote_text(name) + " is ignored");
  }
}

void note_ignored(const Json& document, std::vector<std::string>& notes) {
  const auto note = [&](const Json& list, const char* one, const char* many) {
    if (!list.empty()) notes.push_back(ignored_note(list.size(), one, many));
  };
  note(list_of(document, "animations"), "animation", "animations");
  note(list_of(document, "skins"), "skin", "skins");
  note(list_of(document, "cameras"), "camera", "cameras");
  if (const auto found = document.find("extensions"); found != document.end() && found->is_object()) {
    if (const auto lights = found->find("KHR_lights_punctual"); lights != found->end() && lights->is_object())
      note(list_of(*lights, "lights"), "light", "lights");
  }
  std::size_t morphed = 0;
  for (const Json& mesh : list_of(document, "meshes"))
    for (const Json& primitive : list_of(mesh, "primitives"))
      if (primitive.contains("targets")) ++morphed;
  if (morphed > 0)
    notes.push_back("morph targets of " + std::to_string(morphed) + (morphed == 1 ? " part" : " parts") +
                    " are ignored");
}

Json kept_buffers(const Json& document, const Container& container, const ModelFolder& folder) {
  Json result = Json::array();
  for (const Json& buffer : list_of(document, "buffers")) {
    Json kept = picked(buffer, {"byteLength", "uri"});
    const auto uri = kept.find("uri");
    const bool is_body = container.is_binary && result.empty();
    if (uri == kept.end() && !(is_body && container.body_bytes)) throw Refusal("its buffer has no data");
    if (uri != kept.end()) {
      if (!uri->is_string() || is_body) throw Refusal("its buffer is not where it should be");
      const std::string name = decoded_uri(uri->get<std::string>());
      if (!name.starts_with("data:")) static_cast<void>(folder.find(name, "buffer"));
      *uri = name;
    }
    result.push_back(std::move(kept));
  }
  return result;
}

// A GLB's JSON chunk is padded with blanks to whole words.
std::string container_head(const std::string& json, const Container& container, std::size_t tail_bytes) {
  if (!container.is_binary) return json;
  std::string text = json;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = kHeader_bytes + kChunkHeader_bytes + text.size() + tail_bytes;
  if (total > UINT32_MAX) throw Refusal("it has more than 4 GB", "simplify the model");
  const std::array<std::uint32_t, 5> head = {0x46546c67, 2, static_cast<std::uint32_t>(total),
                                             static_cast<std::uint32_t>(text.size()), kJsonChunk};
  std::string result(sizeof(head), '\0');
  std::memcpy(result.data(), head.data(), sizeof(head));
  return result + text;
}

}  // namespace

GltfFile prepare_gltf(const ModelFolder& folder) {
  const Bytes bytes = vpe::base::read_file(folder.model(), ModelFolder::kMostBytes);
  std::string extension = folder.model().extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const Container container = open_container(bytes, extension == ".glb");
  const Json document = parse(container.json);
  GltfFile result;
  const Json asset = document.value("asset", Json::object());
  const auto version = asset.is_object() ? asset.find("version") : asset.end();
  if (version == asset.end() || !version->is_string() || !version->get<std::string>().starts_with("2."))
    throw Refusal("its JSON does not say that it is glTF 2.0", "save it as glTF 2.0");
  check_extensions(document, result.notes);
  check_nodes(document);
  check_views(document, container.body_bytes);
  note_ignored(document, result.notes);

  Json kept = {{"asset", {{"version", "2.0"}}}};
  std::size_t dropped = 0;
  kept["meshes"] = kept_meshes(document, dropped);
  if (dropped > 0)
    result.notes.push_back(ignored_note(dropped, "part of points or lines", "parts of points or lines"));
  kept["scene"] = document.value("scene", Json(0));
  for (const Json& scene : list_of(document, "scenes")) kept["scenes"].push_back(picked(scene, {"nodes"}));
  for (const Json& node : list_of(document, "nodes"))
    kept["nodes"].push_back(picked(node, {"children", "mesh", "matrix", "translation", "rotation", "scale"}));
  for (const Json& accessor : list_of(document, "accessors"))
    kept["accessors"].push_back(
        picked(accessor, {"bufferView", "byteOffset", "componentType", "normalized", "count", "type"}));
  for (const Json& view : list_of(document, "bufferViews"))
    kept["bufferViews"].push_back(picked(view, {"buffer", "byteOffset", "byteLength", "byteStride"}));
  kept["buffers"] = kept_buffers(document, container, folder);
  keep_materials(document, folder, kept, result.materials, result.notes);

  result.replacement.replaced_bytes = container.json_end;
  result.replacement.head = container_head(kept.dump(), container, bytes.size() - container.json_end);
  return result;
}

}  // namespace objects
