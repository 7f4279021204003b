// Reading and writing of the user's own files; vpe/base/user_folders.h defines where they are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::explore {

// Reads a file; returns nullopt if it does not exist. Throws base::FileError if it cannot be read or is larger
// than 1 MiB.
std::optional<std::string> read_user_file(const std::filesystem::path& file);

// Replaces the file, or the file that it links to, atomically. Creates its folders, accessible to this user
// alone. Two programs may write at the same time; the later one wins. Throws base::FileError; the file is
// unchanged then.
void write_user_file(const std::filesystem::path& file, std::string_view text);

}  // namespace vpe::explore
