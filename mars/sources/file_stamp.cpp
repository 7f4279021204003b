#include "mars/sources/file_stamp.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <string_view>

namespace mars {
namespace {

constexpr std::int64_t kBlock_bytes = 4096;
constexpr std::int64_t kBlocks = 4;

}  // namespace

std::optional<FileStamp> file_stamp(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  FileStamp stamp;
  stamp.path = path;
  stamp.size_bytes = static_cast<std::int64_t>(status.st_size);
  stamp.mtime_ns = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + std::int64_t{status.st_mtim.tv_nsec};
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  const std::int64_t last = std::max<std::int64_t>(0, stamp.size_bytes - kBlock_bytes);
  for (std::int64_t n = 0; n < kBlocks && file; ++n) {
    std::string block(static_cast<std::size_t>(kBlock_bytes), '\0');
    file.seekg(last / (kBlocks - 1) * n);
    file.read(block.data(), kBlock_bytes);
    block.resize(static_cast<std::size_t>(file.gcount()));
    file.clear();
    bytes += block;
  }
  stamp.sample = std::hash<std::string_view>{}(bytes);
  return stamp;
}

std::string changed_file(const std::vector<FileStamp>& stamps) {
  const auto changed = std::ranges::find_if(
      stamps, [](const FileStamp& stamp) { return file_stamp(stamp.path) != std::optional(stamp); });
  return changed == stamps.end() ? "" : changed->path;
}

}  // namespace mars
