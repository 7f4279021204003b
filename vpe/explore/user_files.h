// The user's own files: where they are, by the XDG Base Directory Specification 0.8, and how they are written.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::explore {

// The value of an environment variable, null when it is not set.
using Environment = std::function<const char*(const char* name)>;
Environment process_environment();

// Folders of vpe. A variable that is empty or a relative path counts as not set; then it is the folder in HOME.
// Empty when that is not set either: then nothing is kept.
std::filesystem::path config_folder(const Environment& environment);  // $XDG_CONFIG_HOME/vpe or ~/.config/vpe
std::filesystem::path state_folder(
    const Environment& environment);  // $XDG_STATE_HOME/vpe or ~/.local/state/vpe

// Nothing when there is no such file. Throws core::FileError when it cannot be read or is larger than 1 MiB.
std::optional<std::string> read_user_file(const std::filesystem::path& file);

// Replaces the file at once, or what it is a link to; makes its folders, for this user alone. Two programs may
// write it at the same time: one of them is the last. Throws core::FileError; then the file is as it was.
void write_user_file(const std::filesystem::path& file, std::string_view text);

}  // namespace vpe::explore
