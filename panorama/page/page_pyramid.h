// The pyramid of tiles of a web page, read from images of any size.
//
// A pixel of level k is the mean over 2^k x 2^k pixels of the map's image; level k has half the columns and
// rows of level k - 1, rounded up, and the last one is one tile. Where a closed image goes on at its other
// side, so do the pixels. Tile (column, row) begins at pixel (column * kPageTile_px, row * kPageTile_px) of its
// level; its picture has kPageBorder_px more on every side, so that colours can be interpolated across the
// edges of tiles.
//
// Typical usage:
//   const PagePyramid pyramid = pyramid_of(map);
//   const vpe::core::RgbImage tile = read_page_tile({image, origin, map}, pyramid, level, column, row);
#pragma once

#include <cstdint>

#include "panorama/image/tiled_image.h"
#include "panorama/projection.h"
#include "panorama/viewer/render_view.h"
#include "vpe/core/image/image.h"

namespace panorama {

inline constexpr std::int64_t kPageTile_px = 512;
inline constexpr std::int64_t kPageBorder_px = 1;

struct PagePyramid {
  std::int64_t width_px = 0;  // of level 0: of one eye's image
  std::int64_t height_px = 0;
  int levels = 1;

  // Return the size of a level in pixels, and in tiles.
  std::int64_t level_width_px(int level) const { return part(width_px, level); }
  std::int64_t level_height_px(int level) const { return part(height_px, level); }
  std::int64_t columns(int level) const { return tiles(level_width_px(level)); }
  std::int64_t rows(int level) const { return tiles(level_height_px(level)); }
  // Returns the number of tiles of all levels.
  std::int64_t all_tiles() const;

 private:
  static std::int64_t part(std::int64_t side_px, int level) {
    return (side_px + (std::int64_t{1} << level) - 1) >> level;
  }
  static std::int64_t tiles(std::int64_t side_px) { return (side_px + kPageTile_px - 1) / kPageTile_px; }
};

PagePyramid pyramid_of(const PanoramaMap& map);

// The image of one eye.
struct PageImage {
  const TiledImage& image;
  ImageOrigin origin;  // of the map's image in it
  PanoramaMap map;
};

// A rectangle of pixels of a level; it may reach beyond the level.
struct PageRectangle {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
};

// Returns pixels of a level: means of the stored values, rounded to the nearest. Beyond the edges of the image
// its outermost pixels are repeated, except where a closed image goes on. Reads the tiles of the image that it
// needs. Any thread. Throws vpe::base::FileError.
vpe::core::RgbImage read_page_pixels(const PageImage& from, int level, const PageRectangle& rectangle);

// Returns the picture of a tile, with its border.
vpe::core::RgbImage read_page_tile(const PageImage& from, const PagePyramid& pyramid, int level,
                                   std::int64_t column, std::int64_t row);

}  // namespace panorama
