#include "panorama/metadata/auxiliary_files.h"

#include <nlohmann/json.hpp>

namespace panorama {

namespace {

using nlohmann::json;

// Returns a value for a message; leaves the content of arrays and objects out, which may be nested to any
// depth.
std::string shown(const json& value) {
  return value.is_structured() ? "an " + std::string(value.type_name()) : excerpt(value.dump());
}

std::string file_of(const std::string& name, const json& value) {
  const json* file = &value;
  if (value.is_object()) {
    const auto found = value.find("file");
    if (found != value.end()) file = &*found;
  }
  const std::string text = file->is_string() ? file->get<std::string>() : std::string();
  // A description must not lead anywhere else than to its own folder.
  if (text.empty() || std::filesystem::path(text).filename() != text) {
    throw MetadataError("planes." + excerpt(name) + " is " + shown(*file) +
                        "; give the name of a file in the same folder");
  }
  return text;
}

}  // namespace

std::optional<PairLayout> parse_pair_layout(std::string_view name) {
  if (name == "none") return PairLayout::kNone;
  if (name == "sbs") return PairLayout::kSideBySide;
  if (name == "ou") return PairLayout::kOverUnder;
  return std::nullopt;
}

AuxiliaryFiles read_auxiliary_files(std::string_view text) {
  AuxiliaryFiles files;
  try {
    const json root = json::parse(text);
    if (!root.is_object()) throw MetadataError("JSON without an object {...} of keys");
    if (const auto stereo = root.find("stereo"); stereo != root.end() && !stereo->is_null()) {
      const auto pair = parse_pair_layout(stereo->is_string() ? stereo->get<std::string>() : "");
      if (!pair) throw MetadataError("stereo is " + shown(*stereo) + R"(; give "sbs", "ou" or "none")");
      files.pair = *pair;
    }
    if (const auto planes = root.find("planes"); planes != root.end() && !planes->is_null()) {
      if (!planes->is_object()) throw MetadataError("planes is not an object {...} of names and files");
      for (const auto& [name, value] : planes->items()) files.planes.push_back({name, file_of(name, value)});
    }
  } catch (const json::exception& e) {
    throw MetadataError("not well-formed JSON: " + excerpt(e.what(), 300));
  }
  return files;
}

}  // namespace panorama
