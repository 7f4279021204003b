// The pixels of a panorama of any size, of which only the requested tiles lie in memory.
//
// Typical usage:
//   TiledImageOptions options;
//   options.cache_folder = [] { return folder; };
//   const auto image = open_tiled_image(path, format, options);
//   const auto tile = image->tile(level, column, row);  // in any thread
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "panorama/image/tile_source.h"
#include "panorama/image/xmp_file.h"
#include "vpe/base/lru_cache.h"

namespace panorama {

// Reads tiles of a source and keeps the last used of them within a budget. All const members may be called from
// any number of threads.
class TiledImage {
 public:
  TiledImage(std::unique_ptr<TileSource> source, std::size_t budget_bytes);

  const std::vector<ImageLevel>& levels() const { return source_->levels(); }
  // Returns a tile. It is read once as long as it is kept; several threads that need one tile wait for one
  // reading. Throws what the source throws, and reads again at the next call.
  std::shared_ptr<const Tile> tile(int level, std::int64_t column, std::int64_t row) const;

  // Returns the memory of the tiles kept: at most the budget, or that of the last tile.
  std::size_t bytes() const { return tiles_.bytes(); }
  // Returns the number of tiles read so far.
  std::int64_t reads() const { return reads_; }

 private:
  std::unique_ptr<TileSource> source_;
  mutable vpe::base::LruCache<std::uint64_t, Tile, std::hash<std::uint64_t>> tiles_;
  mutable std::atomic<std::int64_t> reads_ = 0;
};

struct TiledImageOptions {
  static constexpr std::size_t kMinBudget_bytes = std::size_t{16} << 20;
  // Limits everything that is kept of the image. Smaller: more tiles are read again and more images need copies
  // on the disk; larger: more memory. Values below kMinBudget_bytes are raised to it.
  std::size_t budget_bytes = std::size_t{512} << 20;
  // Returns the folder that keeps smaller copies of large images between runs. Called only when one is needed.
  std::function<std::filesystem::path()> cache_folder;
  // Receives the finished fraction while copies are made; may throw to stop.
  std::function<void(double fraction)> progress;
};

// Opens an image of any size within the budget:
// - An image that fits in memory when decoded is decoded.
// - A tiled TIFF with reduced pages is read tile by tile where it is needed.
// - A tiled TIFF without reduced pages is read in the same way; smaller copies are made once in the cache
// folder.
// - A PNG, a JPEG or a TIFF in rows is copied once, row by row, as tiles, into the cache folder. Copies belong
// to path, size and time of the file; removing them only makes the next opening slower. Throws
// vpe::base::FileError: damaged, not readable, no room for the copies, or too large to be decoded in memory
// where that is needed (interlaced PNG, progressive JPEG).
std::unique_ptr<TiledImage> open_tiled_image(const std::filesystem::path& path, ImageFileFormat format,
                                             const TiledImageOptions& options);

}  // namespace panorama
