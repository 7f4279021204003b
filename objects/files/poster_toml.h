// Reads the tables [[picture]] and [[kiosk]] of scene files (poster_entry.h).
#pragma once

#include <filesystem>

#include "objects/files/poster_entry.h"
#include "vpe/base/toml_table.h"

namespace objects {

// Return the entry of a table. Paths are relative to the folder of the scene file. Throw std::runtime_error
// "FILE:LINE: what" for unknown keys, keys of other forms, and values beyond their limits (scene_limits.h).
PosterEntry read_poster(const vpe::base::TomlTable& table, const std::filesystem::path& scene_file);
KioskEntry read_kiosk(const vpe::base::TomlTable& table, const std::filesystem::path& scene_file);

}  // namespace objects
