// Temporary files, NAME.HOST-PID.tmp, with names that allow several processes, also on several machines, to
// write into one folder.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace vpe::app {

// Returns a name beside the file that no other living process uses.
std::filesystem::path temporary_name(const std::filesystem::path& file);

// Writes a file: under its name appears either the whole content or nothing. Throws base::FileError.
void write_whole(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_whole(const std::filesystem::path& file, const std::string& text);

// Removes temporary files that dead processes left in a folder, of those files whose name is_ours() accepts:
// files of this machine at once, files of other machines after a day. Never fails.
void remove_stale_temporaries(const std::filesystem::path& folder,
                              const std::function<bool(const std::string& name)>& is_ours);

}  // namespace vpe::app
