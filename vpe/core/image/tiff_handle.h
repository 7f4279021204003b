// A TIFF opened through libtiff: what the library says of a failure is kept with the handle, and nothing is
// printed or shared with the process's other users of it.
#pragma once

#include <tiffio.h>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace vpe::core {

// Used by one thread at a time. May be moved.
class TiffHandle {
 public:
  // What a description of the file may make the library allocate at once. An image of 100 000 x 20 000 in
  // tiles of 16 x 16 has tables of 60 MB.
  static constexpr tmsize_t kMaxTableBytes = tmsize_t{1} << 28;
  static constexpr tmsize_t kNoLimit = 0;

  TiffHandle() = default;  // closed
  // `mode` is TIFFOpen()'s. get() is null when that fails; words() says why.
  TiffHandle(const std::filesystem::path& path, const char* mode, tmsize_t max_bytes = kNoLimit);
  // On a stream that stays open and outlives the handle: full disks show there, and paths are bytes.
  TiffHandle(std::FILE* stream, const std::filesystem::path& path, const char* mode);

  TIFF* get() const { return tiff_.get(); }
  // The library's last words of error.
  const char* words() const { return words_->text; }
  // words() stay.
  void close() { tiff_.reset(); }

 private:
  struct Words {
    char text[512] = "unknown error";
  };
  std::unique_ptr<Words> words_ = std::make_unique<Words>();  // before the handle, which writes there
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
};

}  // namespace vpe::core
