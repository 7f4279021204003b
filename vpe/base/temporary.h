// Temporary files, NAME.HOST-PID.tmp, with names that allow several processes, also on several machines, to
// write into one folder.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace vpe::base {

// Makes and opens an empty file NAME.HOST-PID.tmp beside `file`, for reading and writing; NAME.HOST-PID-N.tmp
// when this process writes `file` already. Never opens what exists, nor follows a link. Sets `temporary` to its
// name. Returns null, with errno, if it cannot be made.
std::FILE* make_temporary(const std::filesystem::path& file, std::filesystem::path& temporary);

// Returns NAME.HOST-PID.tmp as the name of a folder beside `file`. Nothing is made.
std::filesystem::path temporary_name(const std::filesystem::path& file);

// Returns ".HOST-PID" of this process. It tells files of this process from those of others.
std::string process_mark();

// Returns true if the process that gave `file` the mark ".HOST-PID" or ".HOST-PID-N" is known to be gone: one of
// this machine, or one of another machine that has not written the file for a day. False for other texts.
bool is_abandoned(const std::filesystem::path& file, std::string_view mark);

// Removes what writers that are gone left in a folder: files NAME.HOST-PID.tmp whose NAME is_ours() accepts, of
// this machine at once, of other machines after a day. Files of other names ending in .tmp stay. Never fails.
void remove_stale_temporaries(const std::filesystem::path& folder,
                              const std::function<bool(const std::string& name)>& is_ours);

}  // namespace vpe::base
