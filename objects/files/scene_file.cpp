#include "objects/files/scene_file.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "objects/files/model_references.h"
#include "objects/files/scene_limits.h"
#include "vpe/base/file.h"

namespace objects {

namespace {

constexpr std::size_t kMostPathBytes = 4096;
constexpr std::ptrdiff_t kMostValues = 10'000'000;

std::string problem_of_scene_text(std::string_view text, std::size_t most_bytes) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (!text.empty() && text.size() <= most_bytes && std::ranges::none_of(text, is_control)) return "";
  return "expected a text of 1 to " + std::to_string(most_bytes) + " bytes without control characters";
}

}  // namespace

std::string problem_of_name(std::string_view name) { return problem_of_scene_text(name, kMostNameBytes); }

std::string problem_of_path(std::string_view path) { return problem_of_scene_text(path, kMostPathBytes); }

std::filesystem::path model_path(const std::filesystem::path& scene_file, const std::string& text) {
  return (scene_file.parent_path() / text).lexically_normal();
}

std::string too_many_instances() {
  return "expected at most " + std::to_string(kMostInstances) + " instances in all";
}

std::string problem_of_size(std::string_view text) {
  const auto begins_value = [](char c) { return c == ',' || c == '[' || c == '{' || c == '='; };
  if (text.size() > kMostSceneFileBytes)
    return "expected at most " + std::to_string(kMostSceneFileBytes >> 20U) + " MiB";
  if (std::ranges::count_if(text, begins_value) > kMostValues)
    return "expected at most " + std::to_string(kMostValues) + " values";
  return "";
}

SceneFile read_scene_file(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  const bool is_json = extension == ".geojson" || extension == ".json";
  if (!is_json && extension != ".toml") {
    throw vpe::base::file_error("read", path, "it is neither TOML nor GeoJSON",
                                "name it *.scene.toml, *.geojson or *.json");
  }
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, kMostSceneFileBytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return is_json ? parse_scene_geojson(text, path) : parse_scene_toml(text, path);
}

std::vector<std::filesystem::path> files_of(const SceneFile& scene) {
  std::vector<std::filesystem::path> files{scene.path};
  std::set<std::filesystem::path> known{scene.path};
  for (const ModelEntry& model : scene.models) {
    if (model.formula || !known.insert(model.file).second) continue;
    files.push_back(model.file);
    for (const std::filesystem::path& file : model_references(model.file)) {
      if (known.insert(file).second) files.push_back(file);
    }
  }
  for (const PosterEntry& poster : scene.posters) {
    if (known.insert(poster.file).second) files.push_back(poster.file);
  }
  for (const KioskEntry& kiosk : scene.kiosks) {
    if (!kiosk.hotspots.empty() && known.insert(kiosk.hotspots).second) files.push_back(kiosk.hotspots);
  }
  return files;
}

}  // namespace objects
