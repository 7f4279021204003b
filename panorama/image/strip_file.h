// Files of finished strips of a panorama, kept until the whole image is complete.
//
// A file holds numbered blocks of bytes under a fingerprint of everything that they depend on, with a checksum.
// The format is private to this program: files of another version or machine are ignored.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/base/file.h"

namespace panorama {

// Writes one strip. For one thread.
class StripWriter {
 public:
  // Writes into a file that is empty; the caller commits it. Throws vpe::base::FileError, as all members do.
  StripWriter(vpe::base::OutputFile& file, const std::string& fingerprint);
  void add(std::span<const std::uint8_t> block);
  void finish();

 private:
  vpe::base::OutputFile& file_;
  std::vector<std::uint64_t> sizes_;
  std::int64_t sum_ = 0;
};

// Reads one strip. Any thread may call any const member.
class StripFile {
 public:
  // Opens a file and reads all of it once. Returns nullopt when it is not there, has another fingerprint or
  // number of blocks, or is damaged.
  static std::optional<StripFile> open(const std::filesystem::path& path, const std::string& fingerprint,
                                       std::size_t blocks);

  // Reads a block. Throws vpe::base::FileError. The file is open only during the call.
  std::vector<std::uint8_t> block(std::size_t n) const;

 private:
  std::filesystem::path path_;
  std::vector<std::uint64_t> begin_;  // of each block, and the end of the last
};

}  // namespace panorama
