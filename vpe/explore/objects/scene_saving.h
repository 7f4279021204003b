// Saving of a scene over a file that people may have written.
#pragma once

#include <filesystem>
#include <optional>

#include "objects/files/scene_file.h"
#include "vpe/explore/files/kept_file.h"

namespace vpe::explore {

// Writes a scene to a file. A file that is there is kept as kept_name() if it holds what a scene has not, such as comments
// and the order of its lines, or is no scene, or if `keeps_former`; an earlier kept file is replaced. Returns the kept file, or
// nullopt. Throws what objects::write_scene_file() throws; the file is unchanged then.
std::optional<std::filesystem::path> save_scene(const objects::SceneFile& scene,
                                                const std::filesystem::path& file, bool keeps_former);

}  // namespace vpe::explore
