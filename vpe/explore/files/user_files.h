// How the user's own files are read and written; where they are: vpe/base/user_folders.h.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::explore {

// Nothing when there is no such file. Throws base::FileError when it cannot be read or is larger than 1 MiB.
std::optional<std::string> read_user_file(const std::filesystem::path& file);

// Replaces the file at once, or what it is a link to; makes its folders, for this user alone. Two programs may
// write it at the same time: one of them is the last. Throws base::FileError; then the file is as it was.
void write_user_file(const std::filesystem::path& file, std::string_view text);

}  // namespace vpe::explore
