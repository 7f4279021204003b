#include "vpe/overlook/texture_pixels.h"

#include <algorithm>
#include <memory>

namespace vpe::overlook {

std::vector<std::uint8_t> texture_pixels(const panorama::TiledImage& image, const panorama::LevelGrid& grid,
                                         const TextureKey& key) {
  constexpr std::size_t kChannels = 4;
  constexpr auto kSide = static_cast<std::size_t>(kBorderedSide_px);
  std::vector<std::uint8_t> pixels(kSide * kSide * kChannels, 255);
  std::shared_ptr<const panorama::Tile> tile;
  std::int64_t tile_column = -1;
  std::int64_t tile_row = -1;
  for (std::size_t row = 0; row < kSide; ++row) {
    const std::int64_t y = std::clamp(grid.top + key.row * kTextureSide_px + static_cast<std::int64_t>(row) - 1,
                                      grid.top, grid.bottom);
    for (std::size_t column = 0; column < kSide; ++column) {
      const std::int64_t x =
          grid.wrapped(grid.left + key.column * kTextureSide_px + static_cast<std::int64_t>(column) - 1);
      const std::int64_t wanted_column = x / grid.size.tile_width_px;
      const std::int64_t wanted_row = y / grid.size.tile_height_px;
      if (wanted_column != tile_column || wanted_row != tile_row) {
        tile = image.tile(key.level, wanted_column, wanted_row);
        tile_column = wanted_column;
        tile_row = wanted_row;
      }
      const std::int64_t in_x = x - tile_column * grid.size.tile_width_px;
      const std::int64_t in_y = y - tile_row * grid.size.tile_height_px;
      const base::Rgb& from = tile->pixels[static_cast<std::size_t>(in_y * tile->width_px + in_x)];
      std::uint8_t* to = pixels.data() + (row * kSide + column) * kChannels;
      to[0] = from.r;
      to[1] = from.g;
      to[2] = from.b;
    }
  }
  return pixels;
}

}  // namespace vpe::overlook
