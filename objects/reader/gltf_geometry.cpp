#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/reader/gltf_json.h"
#include "objects/reader/refusal.h"

namespace objects {

namespace {

constexpr std::size_t kMostLevels = 1000;
constexpr std::uint64_t kMostBuffer_bytes = std::uint64_t{1} << 40;

enum Component : std::uint64_t { kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126 };
enum Mode : std::uint64_t { kTriangles = 4, kFan = 6 };

std::uint64_t component_bytes(std::uint64_t component) {
  return component == kByte ? 1 : component == kShort ? 2 : 4;
}

struct Kind {
  const char* words;
  std::vector<std::string> types;
  std::vector<std::uint64_t> components;
};

const Kind kVectors{"positions or normals", {"VEC3"}, {kFloat}};
const Kind kUvs{"texture coordinates", {"VEC2"}, {kFloat}};
const Kind kColours{"colours", {"VEC3", "VEC4"}, {kByte, kShort, kFloat}};
const Kind kIndices{"indices", {"SCALAR"}, {kByte, kShort, kInt}};

// Returns the number of elements.
std::uint64_t checked_count(const Json& document, const Json& object, const char* key, const Kind& kind) {
  const Json& accessors = list_of(document, "accessors");
  const Json& accessor = accessors.at(*index_of(object, key, accessors.size()));
  const std::string words = std::string("its ") + kind.words;
  if (accessor.contains("sparse"))
    throw Refusal(words + " are stored as a sparse array, which is not read", "save it with plain arrays");
  const auto type = accessor.find("type");
  const std::uint64_t component = whole_of(accessor, "componentType", 65535).value_or(0);
  if (type == accessor.end() || !type->is_string() ||
      std::find(kind.types.begin(), kind.types.end(), type->get<std::string>()) == kind.types.end() ||
      std::find(kind.components.begin(), kind.components.end(), component) == kind.components.end())
    throw Refusal(
        words + " are stored as a type that is not read (component " + std::to_string(component) + ")",
        "save it without quantization");
  const std::uint64_t count = whole_of(accessor, "count", 4 * MeshLimits::kMostTriangles).value_or(0);
  const Json& views = list_of(document, "bufferViews");
  const std::optional<std::size_t> view_index = index_of(accessor, "bufferView", views.size());
  if (!view_index || count == 0) throw Refusal(words + " have no data");
  const Json& view = views.at(*view_index);
  const std::string type_name = type->get<std::string>();
  const std::uint64_t numbers = type_name == "SCALAR" ? 1 : static_cast<std::uint64_t>(type_name.back() - '0');
  const std::uint64_t element = numbers * component_bytes(component);
  const std::uint64_t stride = std::max<std::uint64_t>(whole_of(view, "byteStride", 252).value_or(0), 0);
  const std::uint64_t step = stride == 0 ? element : stride;
  const std::uint64_t end =
      whole_of(accessor, "byteOffset", kMostBuffer_bytes).value_or(0) + (count - 1) * step + element;
  if (step < element || end > whole_of(view, "byteLength", kMostBuffer_bytes).value_or(0))
    throw Refusal(words + " reach beyond their buffer");
  return count;
}

Json kept_primitive(const Json& document, const Json& primitive) {
  const auto attributes = primitive.find("attributes");
  if (attributes == primitive.end() || !attributes->is_object() || !attributes->contains("POSITION"))
    throw Refusal("a part of it has no positions");
  Json kept = Json::object();
  const std::uint64_t vertices = checked_count(document, *attributes, "POSITION", kVectors);
  kept["POSITION"] = attributes->at("POSITION");
  const auto keep = [&](const std::string& name, const Kind& kind) {
    if (!attributes->contains(name)) return false;
    if (checked_count(document, *attributes, name.c_str(), kind) != vertices)
      throw Refusal(std::string("its ") + kind.words + " are not as many as its positions");
    kept[name] = attributes->at(name);
    return true;
  };
  keep("NORMAL", kVectors);
  keep("COLOR_0", kColours);
  for (int set = 0; set < 8 && keep("TEXCOORD_" + std::to_string(set), kUvs); ++set) {
  }
  Json result = picked(primitive, {"mode", "indices", "material"});
  result["attributes"] = kept;
  static_cast<void>(index_of(primitive, "material", list_of(document, "materials").size()));
  const std::uint64_t corners =
      primitive.contains("indices") ? checked_count(document, primitive, "indices", kIndices) : vertices;
  return corners < 3 ? Json() : result;
}

}  // namespace

void check_nodes(const Json& document) {
  const Json& nodes = list_of(document, "nodes");
  const Json& scenes = list_of(document, "scenes");
  const auto indices = [&](const Json& object, const char* key) {
    std::vector<std::size_t> result;
    const auto found = object.find(key);
    if (found == object.end()) return result;
    if (!found->is_array()) throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" is not an array");
    for (const Json& index : *found) {
      if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= nodes.size())
        throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" names a node beyond the last one");
      result.push_back(index.get<std::size_t>());
    }
    return result;
  };
  std::vector<std::uint8_t> parents(nodes.size(), 0);
  const auto adopt = [&](std::size_t child) {
    if (parents[child]++ > 0)
      throw Refusal("its node " + std::to_string(child) + " has two parents or is its own");
  };
  for (const Json& node : nodes) {
    for (const std::size_t child : indices(node, "children")) adopt(child);
    static_cast<void>(index_of(node, "mesh", list_of(document, "meshes").size()));
    check_numbers(node, "matrix", 16);
    check_numbers(node, "translation", 3);
    check_numbers(node, "rotation", 4);
    check_numbers(node, "scale", 3);
  }
  if (scenes.empty()) throw Refusal("it has no scene", "save it with a scene");
  const std::size_t shown = index_of(document, "scene", scenes.size()).value_or(0);
  std::vector<std::size_t> level = indices(scenes.at(shown), "nodes");
  for (const std::size_t root : level) adopt(root);
  // As no node has two parents, circles are not reached from the scene.
  for (std::size_t depth = 1; !level.empty(); ++depth) {
    if (depth > kMostLevels)
      throw Refusal("its nodes are nested over " + std::to_string(kMostLevels) + " deep", "join its parts");
    std::vector<std::size_t> next;
    for (const std::size_t node : level)
      for (const std::size_t child : indices(nodes.at(node), "children")) next.push_back(child);
    level = std::move(next);
  }
}

void check_views(const Json& document, std::optional<std::uint64_t> body_bytes) {
  const Json& buffers = list_of(document, "buffers");
  for (const Json& view : list_of(document, "bufferViews")) {
    const std::optional<std::size_t> buffer = index_of(view, "buffer", buffers.size());
    if (!buffer) throw Refusal("a part of its data names no buffer");
    std::uint64_t bytes = whole_of(buffers.at(*buffer), "byteLength", kMostBuffer_bytes).value_or(0);
    if (*buffer == 0 && body_bytes) bytes = std::min(bytes, *body_bytes);
    const std::uint64_t offset = whole_of(view, "byteOffset", kMostBuffer_bytes).value_or(0);
    if (offset + whole_of(view, "byteLength", kMostBuffer_bytes).value_or(0) > bytes)
      throw Refusal("a part of its data reaches beyond the end of its buffer");
  }
}

Json kept_meshes(const Json& document, std::size_t& dropped) {
  Json result = Json::array();
  for (const Json& mesh : list_of(document, "meshes")) {
    Json primitives = Json::array();
    for (const Json& primitive : list_of(mesh, "primitives")) {
      const std::uint64_t mode = whole_of(primitive, "mode", kFan).value_or(kTriangles);
      const Json kept = mode < kTriangles ? Json() : kept_primitive(document, primitive);
      if (kept.is_null())
        ++dropped;
      else
        primitives.push_back(kept);
    }
    result.push_back({{"primitives", primitives}});
  }
  return result;
}

}  // namespace objects
