// Folders for the files of a user, by the XDG Base Directory Specification 0.8.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace vpe::base {

// Returns the value of an environment variable, or null if it is not set.
using Environment = std::function<const char*(const char* name)>;

// Returns the environment of this process.
Environment process_environment();

enum class UserFolder : std::uint8_t {
  kCache,   // $XDG_CACHE_HOME/vpe or ~/.cache/vpe: may be deleted at any time
  kConfig,  // $XDG_CONFIG_HOME/vpe or ~/.config/vpe
  kData,    // $XDG_DATA_HOME/vpe or ~/.local/share/vpe
  kState,   // $XDG_STATE_HOME/vpe or ~/.local/state/vpe
};

// Returns the path of a folder, which need not exist. A variable that is empty or holds a relative path counts
// as not set; then the folder lies in HOME. Returns an empty path if HOME is not set either; then nothing can
// be kept.
std::filesystem::path user_folder(UserFolder folder, const Environment& environment = process_environment());

// Returns the folders to search for configuration files, in this order: the user's folder, then vpe in each
// absolute path of $XDG_CONFIG_DIRS (/etc/xdg if that is not set).
std::vector<std::filesystem::path> config_folders(const Environment& environment = process_environment());

}  // namespace vpe::base
