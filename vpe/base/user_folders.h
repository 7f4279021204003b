// Where a user's own files are kept: the XDG Base Directory Specification 0.8, in one place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace vpe::base {

// The value of an environment variable, null when it is not set.
using Environment = std::function<const char*(const char* name)>;
Environment process_environment();

enum class UserFolder : std::uint8_t {
  kCache,   // $XDG_CACHE_HOME/vpe or ~/.cache/vpe: may be deleted at any time
  kConfig,  // $XDG_CONFIG_HOME/vpe or ~/.config/vpe
  kData,    // $XDG_DATA_HOME/vpe or ~/.local/share/vpe
  kState,   // $XDG_STATE_HOME/vpe or ~/.local/state/vpe
};

// A variable that is empty or a relative path counts as not set; then it is the folder in HOME. Empty when that is
// not set either: then nothing is kept. The folder need not exist.
std::filesystem::path user_folder(UserFolder folder, const Environment& environment = process_environment());

// Where settings are looked for: the user's folder, then vpe in each of $XDG_CONFIG_DIRS (/etc/xdg when not set)
// that is an absolute path.
std::vector<std::filesystem::path> config_folders(const Environment& environment = process_environment());

}  // namespace vpe::base
