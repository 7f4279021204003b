// Random access to the bytes of a file or of memory.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "panorama/image/metadata_error.h"

namespace panorama {

// Reads bytes where they are needed. For one thread at a time.
class Input {
 public:
  // Opens a file. Throws vpe::base::FileError when that fails, as for a folder.
  explicit Input(const std::filesystem::path& path);
  // Reads memory, which must outlive the object.
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes), size_(bytes.size()) {}

  std::uint64_t size() const { return size_; }

  // Fills `out` with the bytes from `at` on. Throws MetadataError when there are too few.
  void read(std::uint64_t at, std::span<std::uint8_t> out) const;
  std::string read_text(std::uint64_t at, std::size_t size) const;

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_{nullptr, std::fclose};
  std::span<const std::uint8_t> bytes_;
  std::uint64_t size_ = 0;
};

}  // namespace panorama
