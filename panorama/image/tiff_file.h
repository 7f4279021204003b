// TIFF and BigTIFF files that are read in parts. Private to panorama.
#pragma once

#include <cstdint>
#include <filesystem>

#include "vpe/base/file.h"
#include "vpe/core/image/tiff_handle.h"

namespace panorama {

// Holds one open file, for one thread at a time. Messages of the library are kept, not printed; memory maps are
// not used; tables of tiles are read where they are needed.
class TiffFile {
 public:
  // Opens a file. Throws vpe::base::FileError.
  explicit TiffFile(std::filesystem::path path);
  // Opens the file that `other` has open, also when another one has taken its path since. Throws
  // vpe::base::FileError.
  struct Same {
    const TiffFile& other;
  };
  explicit TiffFile(Same same);

  TIFF* get() const { return tiff_.get(); }
  const std::filesystem::path& path() const { return path_; }

  // Returns a field of the current directory, or the library's default for it, or `otherwise`.
  template <class Value>
  Value field(std::uint32_t tag, Value otherwise) const {
    Value value = otherwise;
    return TIFFGetFieldDefaulted(get(), tag, &value) == 1 ? value : otherwise;
  }

  // Returns the error "cannot read 'PATH': " with the library's last words.
  vpe::base::FileError damaged() const;

 private:
  TiffFile(std::filesystem::path path, const std::filesystem::path& opened);

  std::filesystem::path path_;
  vpe::core::TiffHandle tiff_;
};

}  // namespace panorama
