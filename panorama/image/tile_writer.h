// Tiled BigTIFF files written row by row, for copies of images. Private to panorama.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "panorama/image/tile_source.h"
#include "vpe/base/file.h"
#include "vpe/core/image/tiff_handle.h"

namespace panorama {

// Writes RGB, deflated, under its final name from the start; use it in a folder that is renamed when all files
// are complete. Holds one row of tiles. For one thread. All members throw vpe::base::FileError.
//
// BigTiffWriter takes packed tiles in any order instead, of 256 x 256 pixels. Copies need rows, since all
// levels are written at once, and lower tiles where memory is short.
class TileWriter {
 public:
  // Opens the file. Sides of tiles are multiples of 16.
  TileWriter(std::filesystem::path path, const ImageLevel& level);
  // Takes the next row.
  void take(std::span<const vpe::base::Rgb> row);
  // Ends the file after the last row.
  void finish();

 private:
  [[noreturn]] void fail() const;
  void write_tiles();

  std::filesystem::path path_;
  ImageLevel level_;
  vpe::core::TiffHandle tiff_;
  std::vector<vpe::base::Rgb> rows_;  // of one row of tiles
  std::vector<vpe::base::Rgb> tile_;
  std::int64_t kept_ = 0;
  std::uint32_t next_tile_ = 0;
};

}  // namespace panorama
