// A finished strip of a panorama on disk, until the whole is there.
//
// Numbered blocks of bytes under a fingerprint of all that they depend on, with a checksum. A file private to
// this program: another version's or machine's is simply not taken.
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

class StripWriter {
 public:
  // Into a file that is empty; the caller commits it. Throws vpe::base::FileError.
  StripWriter(vpe::base::OutputFile& file, const std::string& fingerprint);
  void add(std::span<const std::uint8_t> block);
  void finish();

 private:
  vpe::base::OutputFile& file_;
  std::vector<std::uint64_t> sizes_;
  std::int64_t sum_ = 0;
};

class StripFile {
 public:
  // Reads all of it once. Nothing when it is not there, of another fingerprint or number of blocks, or damaged.
  static std::optional<StripFile> open(const std::filesystem::path& path, const std::string& fingerprint,
                                       std::size_t blocks);

  // Throws vpe::base::FileError. The file is open only during the call.
  std::vector<std::uint8_t> block(std::size_t n) const;

 private:
  std::filesystem::path path_;
  std::vector<std::uint64_t> begin_;  // of each block, and the end of the last
};

}  // namespace panorama
