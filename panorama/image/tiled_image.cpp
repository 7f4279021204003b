#include "panorama/image/tiled_image.h"

#include <utility>

namespace panorama {

namespace {

std::uint64_t key_of(int level, std::int64_t column, std::int64_t row) {
  // Sides of up to 1 000 000 pixels in tiles of a pixel fit.
  return static_cast<std::uint64_t>(level) << 48 | static_cast<std::uint64_t>(row) << 24 |
         static_cast<std::uint64_t>(column);
}

std::size_t bytes_of(const Tile& tile) { return tile.pixels.size() * sizeof(vpe::base::Rgb) + sizeof(Tile); }

}  // namespace

TiledImage::TiledImage(std::unique_ptr<TileSource> source, std::size_t budget_bytes)
    : source_(std::move(source)), tiles_(budget_bytes) {}

std::shared_ptr<const Tile> TiledImage::tile(int level, std::int64_t column, std::int64_t row) const {
  return tiles_.get_once(key_of(level, column, row), [&] {
    ++reads_;
    std::shared_ptr<const Tile> tile = source_->read(level, column, row);
    const std::size_t bytes = bytes_of(*tile);
    return std::pair(std::move(tile), bytes);
  });
}

}  // namespace panorama
