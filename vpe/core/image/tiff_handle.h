// TIFF files opened through libtiff, for reading and writing.
//
// Messages of the library are kept with the handle. Nothing is printed, and nothing is shared with the
// process's other users of libtiff.
//
// Typical usage:
//   TiffHandle tiff(file.stream(), path, "w8");
//   if (tiff.get() == nullptr || !set_layout(tiff.get(), layout)) {
//     throw base::file_error("write", path, tiff.words(), advice);
//   }
#pragma once

#include <tiffio.h>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace vpe::core {

// Owns an open file. May be moved. For one thread at a time.
class TiffHandle {
 public:
  // Limits what a description of the file may make the library allocate at once. An image of 100 000 x 20 000
  // in tiles of 16 x 16 has tables of 60 MB.
  static constexpr tmsize_t kMaxTableBytes = tmsize_t{1} << 28;
  static constexpr tmsize_t kNoLimit = 0;

  TiffHandle() = default;  // closed
  // Opens a file. `mode` is TIFFOpen()'s. get() is null when that fails; words() says why.
  TiffHandle(const std::filesystem::path& path, const char* mode, tmsize_t max_bytes = kNoLimit);
  // Opens a stream that stays open and outlives the handle: full disks show there, and paths are bytes.
  TiffHandle(std::FILE* stream, const std::filesystem::path& path, const char* mode);

  TIFF* get() const { return tiff_.get(); }
  // Returns the library's last error message.
  const char* words() const { return words_->text; }
  // Closes the file; words() stay.
  void close() { tiff_.reset(); }

 private:
  struct Words {
    char text[512] = "unknown error";
  };
  std::unique_ptr<Words> words_ = std::make_unique<Words>();  // before the handle, which writes there
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
};

// Describes the pixels of a page that is written. Samples of a pixel lie together. Samples of 8 bits are whole
// numbers, others IEEE floating point.
struct TiffLayout {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint16_t samples = 1;                     // 3 of 8 bits are RGB, others have no colour meaning
  std::uint16_t bits = 8;                        // of a sample
  std::uint16_t compression = COMPRESSION_NONE;  // libtiff's number; all but COMPRESSION_NONE get a predictor
  // Rows of a strip when tile_width_px is 0, else the height of a tile. Sides of tiles are multiples of 16.
  std::uint32_t tile_width_px = 0;
  std::uint32_t tile_height_px = 0;
};

// Sets the fields of a page. Returns false when the library refuses one.
bool set_layout(TIFF* tiff, const TiffLayout& layout);

}  // namespace vpe::core
