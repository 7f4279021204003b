// A TIFF or BigTIFF that is read in parts. Private to panorama.
#pragma once

#include <tiffio.h>

#include <cstdarg>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "vpe/core/file.h"

namespace panorama {

// One handle, used by one thread at a time. Messages of the library are kept, not printed; memory maps are not
// used; tables of tiles are read where they are needed.
class TiffFile {
 public:
  // Throws vpe::core::FileError.
  explicit TiffFile(std::filesystem::path path);

  TIFF* get() const { return tiff_.get(); }
  const std::filesystem::path& path() const { return path_; }

  template <class Value>
  Value field(std::uint32_t tag, Value otherwise) const {
    Value value = otherwise;
    return TIFFGetFieldDefaulted(get(), tag, &value) == 1 ? value : otherwise;
  }

  // "cannot read 'PATH': " with the library's last words.
  vpe::core::FileError damaged() const;

 private:
  struct Words {
    char text[512] = "unknown error";
  };
  static int keep_words(TIFF* tiff, void* user, const char* module, const char* format, std::va_list arguments);
  static int ignore_words(TIFF* tiff, void* user, const char* module, const char* format,
                          std::va_list arguments);

  std::filesystem::path path_;
  std::unique_ptr<Words> words_ = std::make_unique<Words>();
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
};

}  // namespace panorama
