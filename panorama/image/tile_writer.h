// One image as a tiled BigTIFF, written row by row. Private to panorama.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "panorama/image/tile_source.h"
#include "vpe/base/file.h"
#include "vpe/core/image/tiff_handle.h"

namespace panorama {

// RGB, deflated, under its final name from the start: for files in a folder that nobody sees yet. Keeps one row
// of tiles. All throw vpe::base::FileError.
class TileWriter {
 public:
  // Sides of tiles: multiples of 16.
  TileWriter(std::filesystem::path path, const ImageLevel& level);
  void take(std::span<const vpe::base::Rgb> row);
  // After the last row.
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
