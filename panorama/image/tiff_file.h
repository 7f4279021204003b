// A TIFF or BigTIFF that is read in parts. Private to panorama.
#pragma once

#include <cstdint>
#include <filesystem>

#include "vpe/base/file.h"
#include "vpe/core/image/tiff_handle.h"

namespace panorama {

// One handle, used by one thread at a time. Messages of the library are kept, not printed; memory maps are not
// used; tables of tiles are read where they are needed.
class TiffFile {
 public:
  // Throws vpe::base::FileError.
  explicit TiffFile(std::filesystem::path path);

  TIFF* get() const { return tiff_.get(); }
  const std::filesystem::path& path() const { return path_; }

  template <class Value>
  Value field(std::uint32_t tag, Value otherwise) const {
    Value value = otherwise;
    return TIFFGetFieldDefaulted(get(), tag, &value) == 1 ? value : otherwise;
  }

  // "cannot read 'PATH': " with the library's last words.
  vpe::base::FileError damaged() const;

 private:
  std::filesystem::path path_;
  vpe::core::TiffHandle tiff_;
};

}  // namespace panorama
