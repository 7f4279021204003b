#include "vpe/explore/objects/scene_saving.h"

#include <exception>
#include <string_view>

#include "objects/files/scene_writer.h"

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

std::optional<fs::path> save_scene(const objects::SceneFile& scene, const fs::path& file, bool keeps_former) {
  return save_text(file, objects::to_toml(scene, file),
                   {keeps_former, objects::kMostSceneFileBytes,
                    [&file](std::string_view former) { return is_as_written(file, former); }});
}

}  // namespace vpe::explore
