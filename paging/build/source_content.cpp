#include "paging/build/source_content.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "paging/planet/codec.h"

namespace paging {

namespace {

constexpr std::int64_t kSampledBlock_bytes = 4096;
constexpr std::int64_t kMostBlocksOfFile = 64;
constexpr std::int64_t kFewestBlocksOfFile = 4;
constexpr std::int64_t kBlocksOfAllFiles = 4096;  // virtual rasters may have thousands of files

void append_number(Bytes& bytes, std::int64_t number) {
  for (int shift = 0; shift < 64; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> shift));
}

}  // namespace

std::string content_of(const mars::SourceInfo& source) {
  if (source.files.empty()) return {};
  const auto files = static_cast<std::int64_t>(source.files.size());
  const std::int64_t blocks = std::clamp(kBlocksOfAllFiles / files, kFewestBlocksOfFile, kMostBlocksOfFile);
  Bytes sums;
  for (const mars::FileStamp& stamp : source.files) {
    std::ifstream file(stamp.path, std::ios::binary);
    const std::int64_t last = std::max<std::int64_t>(0, stamp.size_bytes - kSampledBlock_bytes);
    Bytes bytes;
    for (std::int64_t n = 0; n < blocks && file; ++n) {
      std::string block(static_cast<std::size_t>(kSampledBlock_bytes), '\0');
      file.seekg(last / (blocks - 1) * n + (n + 1 == blocks ? last % (blocks - 1) : 0));
      file.read(block.data(), kSampledBlock_bytes);
      bytes.insert(bytes.end(), block.begin(), block.begin() + file.gcount());
      file.clear();
    }
    append_number(sums, checksum(stamp.size_bytes, bytes));
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(checksum(files, sums)));
  return text;
}

}  // namespace paging
