// The pixels of an image and of smaller copies of it, by tiles.
//
// Level 0 is the image. Every level shows all of it: column x of level 0 is x * width(k) / width(0) of level k,
// likewise rows, for any sizes. Tile (column, row) begins at pixel (column * tile_width, row * tile_height) of
// its level; the last tile of a row or column may reach beyond the level, where its pixels are undefined.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vpe/base/rgb.h"

namespace panorama {

struct ImageLevel {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  int tile_width_px = 0;
  int tile_height_px = 0;

  std::int64_t tile_columns() const { return (width_px + tile_width_px - 1) / tile_width_px; }
  std::int64_t tile_rows() const { return (height_px + tile_height_px - 1) / tile_height_px; }
};

struct Tile {
  int width_px = 0;
  int height_px = 0;
  std::vector<vpe::base::Rgb> pixels;  // in rows
};

// Reads tiles. Any number of threads may read at a time.
class TileSource {
 public:
  virtual ~TileSource() = default;
  virtual const std::vector<ImageLevel>& levels() const = 0;
  // Returns a tile, never null. Throws vpe::base::FileError.
  virtual std::shared_ptr<const Tile> read(int level, std::int64_t column, std::int64_t row) const = 0;
};

}  // namespace panorama
