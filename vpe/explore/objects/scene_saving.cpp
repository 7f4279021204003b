#include "vpe/explore/objects/scene_saving.h"

#include <exception>
#include <string_view>

#include "objects/files/scene_writer.h"
#include "vpe/base/file.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

// Returns true if the file is as objects::to_toml() writes it: what it says is all in the scene.
bool is_as_written(const fs::path& file, std::string_view text) {
  try {
    return objects::to_toml(objects::parse_scene_toml(text, file), file) == text;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

fs::path kept_name(const fs::path& file) {
  fs::path kept = file;
  kept += "~";
  return kept;
}

std::optional<fs::path> save_scene(const objects::SceneFile& scene, const fs::path& file, bool keeps_former) {
  const std::string text = objects::to_toml(scene, file);
  std::optional<fs::path> kept;
  std::error_code unknown;
  if (fs::exists(file, unknown)) {
    const std::vector<std::uint8_t> bytes = base::read_file(file, objects::kMostSceneFileBytes);
    const std::string_view former(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (former != text && (keeps_former || !is_as_written(file, former))) {
      kept = kept_name(file);
      base::write_file(*kept, bytes);
    }
  }
  base::write_file(file, text);
  return kept;
}

}  // namespace vpe::explore
