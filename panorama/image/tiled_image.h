// A panorama's pixels, of which only what is asked for lies in memory.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "panorama/image/tile_source.h"
#include "panorama/image/xmp_file.h"

namespace panorama {

// The tiles of a source, the last used of them kept within a budget. All const members may be called from any
// number of threads.
class TiledImage {
 public:
  TiledImage(std::unique_ptr<TileSource> source, std::size_t budget_bytes);

  const std::vector<ImageLevel>& levels() const { return source_->levels(); }
  // Reads it at most once while it is kept; several threads that ask for one tile wait for one reading. Throws
  // what the source throws, and reads again when asked again.
  std::shared_ptr<const Tile> tile(int level, std::int64_t column, std::int64_t row) const;

  std::size_t bytes() const;  // of the tiles kept; at most the budget, or the last tile
  std::int64_t reads() const;

 private:
  struct Entry {
    std::shared_ptr<const Tile> tile;  // null while it is read
    std::list<std::uint64_t>::iterator place;
  };

  std::unique_ptr<TileSource> source_;
  std::size_t budget_bytes_;
  mutable std::mutex mutex_;
  mutable std::condition_variable read_;
  mutable std::unordered_map<std::uint64_t, Entry> tiles_;
  mutable std::list<std::uint64_t> order_;  // last used first
  mutable std::size_t bytes_ = 0;
  mutable std::int64_t reads_ = 0;
};

struct TiledImageOptions {
  static constexpr std::size_t kMinBudget_bytes = std::size_t{16} << 20;
  std::size_t budget_bytes = std::size_t{512} << 20;  // for everything that is kept of the image
  // Where smaller copies of large images are kept between runs; asked for only when one is needed.
  std::function<std::filesystem::path()> cache_folder;
  std::function<void(double fraction)> progress;  // of making them; may throw to stop
};

// An image of any size within the budget:
//   fits unpacked            in memory
//   tiled TIFF with reduced  tiles are read where they are needed, nothing else
//   copies
//   tiled TIFF without       the same, smaller copies are made once in the cache folder
//   PNG, JPEG, TIFF in rows  the whole image is copied once, row by row, tiled, into the cache folder
// Copies belong to path, size and time of the file; whoever removes them only makes the next opening slower.
// Throws vpe::base::FileError: damaged, not readable, no room for the copies, or too large to be unpacked where
// that is needed (interlaced PNG, progressive JPEG).
std::unique_ptr<TiledImage> open_tiled_image(const std::filesystem::path& path, ImageFileFormat format,
                                             const TiledImageOptions& options);

}  // namespace panorama
