// Names for files that are being written, so that several processes, also on several machines, may write into
// one folder: NAME.HOST-PID.tmp.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace vpe::app {

// Beside the file, and no other living process's.
std::filesystem::path temporary_name(const std::filesystem::path& file);

// Writes all or nothing under the file's name. Throws base::FileError.
void write_whole(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_whole(const std::filesystem::path& file, const std::string& text);

// Removes what dead processes left half-written of the files in a folder that is_ours() accepts by name: those
// of this machine at once, those of others after a day. Never fails.
void remove_stale_temporaries(const std::filesystem::path& folder,
                              const std::function<bool(const std::string& name)>& is_ours);

}  // namespace vpe::app
