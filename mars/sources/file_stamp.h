// Stamps of a source's files, by which a change while they are read is noticed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mars {

// Describes a local file at one time.
struct FileStamp {
  std::string path;
  std::int64_t size_bytes = 0;
  std::int64_t mtime_ns = 0;  // since 1970
  std::size_t sample = 0;     // hash of a few blocks; differs from run to run
  bool operator==(const FileStamp&) const = default;
};

// Returns the stamp of a file, or nullopt if it is not a regular file that can be read: archives and remote files
// of GDAL have none.
std::optional<FileStamp> file_stamp(const std::string& path);

// Returns the path of the first file that is no longer as its stamp says, or "".
std::string changed_file(const std::vector<FileStamp>& stamps);

}  // namespace mars
