#include "panorama/image/tiled_image.h"

#include <algorithm>
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
    : source_(std::move(source)), budget_bytes_(budget_bytes) {}

std::shared_ptr<const Tile> TiledImage::tile(int level, std::int64_t column, std::int64_t row) const {
  const std::uint64_t key = key_of(level, column, row);
  std::unique_lock lock(mutex_);
  for (;;) {
    const auto found = tiles_.find(key);
    if (found == tiles_.end()) break;
    if (found->second.tile != nullptr) {
      order_.splice(order_.begin(), order_, found->second.place);
      return found->second.tile;
    }
    read_.wait(lock);
  }
  tiles_.emplace(key, Entry{nullptr, order_.end()});
  ++reads_;
  lock.unlock();
  std::shared_ptr<const Tile> tile;
  try {
    tile = source_->read(level, column, row);
  } catch (...) {
    lock.lock();
    tiles_.erase(key);
    read_.notify_all();
    throw;
  }
  lock.lock();
  order_.push_front(key);
  tiles_[key] = {tile, order_.begin()};
  bytes_ += bytes_of(*tile);
  while (bytes_ > budget_bytes_ && order_.size() > 1) {
    const auto oldest = tiles_.find(order_.back());
    bytes_ -= bytes_of(*oldest->second.tile);
    tiles_.erase(oldest);
    order_.pop_back();
  }
  read_.notify_all();
  return tile;
}

std::size_t TiledImage::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::int64_t TiledImage::reads() const {
  const std::lock_guard lock(mutex_);
  return reads_;
}

}  // namespace panorama
