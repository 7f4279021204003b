// Bytes of a file or of memory, read where asked for.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "panorama/image/metadata_error.h"

namespace panorama {

class Input {
 public:
  // Throws vpe::base::FileError when the file cannot be opened, as for a folder.
  explicit Input(const std::filesystem::path& path);
  // The bytes must outlive it.
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes), size_(bytes.size()) {}

  std::uint64_t size() const { return size_; }

  // Fills `out` from byte `at` on. Throws MetadataError when there are not so many. By one thread at a time.
  void read(std::uint64_t at, std::span<std::uint8_t> out) const;
  std::string read_text(std::uint64_t at, std::size_t size) const;

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_{nullptr, std::fclose};
  std::span<const std::uint8_t> bytes_;
  std::uint64_t size_ = 0;
};

}  // namespace panorama
