// One picture as a tiled BigTIFF, written row by row. Private to panorama.
#pragma once

#include <tiffio.h>

#include <cstdarg>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "panorama/tiles.h"
#include "vpe/core/file.h"

namespace panorama {

// RGB, deflated, under its final name from the start: for files in a folder that nobody sees yet. Keeps one row
// of tiles. All throw vpe::core::FileError.
class TileWriter {
 public:
  // Sides of tiles: multiples of 16.
  TileWriter(std::filesystem::path path, const PictureLevel& level);
  void take(std::span<const mars::Rgb> row);
  // After the last row.
  void finish();

 private:
  struct Words {
    char text[512] = "unknown error";
  };
  static int keep_words(TIFF* tiff, void* user, const char* module, const char* format, std::va_list arguments);
  [[noreturn]] void fail() const;
  void write_tiles();

  std::filesystem::path path_;
  PictureLevel level_;
  std::unique_ptr<Words> words_ = std::make_unique<Words>();
  std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
  std::vector<mars::Rgb> rows_;  // of one row of tiles
  std::vector<mars::Rgb> tile_;
  std::int64_t kept_ = 0;
  std::uint32_t next_tile_ = 0;
};

}  // namespace panorama
