// Planet files that a user may want to open.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace vpe::explore {

// Returns the files "*.vpe" in some folders, by name, each once, at most kMostPlanets. Folders that cannot be read, or are
// given as empty paths, have none. Reads directories and no files.
inline constexpr std::size_t kMostPlanets = 100;
std::vector<std::filesystem::path> planet_files(std::span<const std::filesystem::path> folders);

}  // namespace vpe::explore
