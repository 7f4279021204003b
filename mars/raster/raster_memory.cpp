#include "mars/raster/raster_memory.h"

#include <gdal.h>

#include <algorithm>
#include <atomic>

#include "mars/raster/gdal_tiles.h"

namespace mars {

void set_raster_memory(std::size_t bytes) {
  bytes = std::max(bytes, std::size_t{16} << 20);
  // GDAL's share only bridges the tiles that lie in one row of its blocks: pieces are kept decoded.
  GDALSetCacheMax64(static_cast<GIntBig>(bytes / 4));
  TileStore::common().set_limit(bytes - bytes / 4);
}

TileStore& TileStore::common() {
  static TileStore store(kDefaultRasterMemory - kDefaultRasterMemory / 4);
  return store;
}

std::uint64_t TileStore::next_cache() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

TileStore::Pointer TileStore::find(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(key);
  if (found == places_.end()) return nullptr;
  order_.splice(order_.begin(), order_, found->second);
  return found->second->tile;
}

TileStore::Pointer TileStore::insert(const Key& key, Pointer tile, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto found = places_.find(key);
  if (found != places_.end()) return found->second->tile;
  order_.push_front({key, std::move(tile), bytes + kEntryBytes});
  places_.emplace(key, order_.begin());
  bytes_ += order_.front().bytes;
  shrink();
  return order_.front().tile;
}

void TileStore::forget(std::uint64_t cache) {
  const std::lock_guard lock(mutex_);
  for (auto at = order_.begin(); at != order_.end();) {
    const auto next = std::next(at);
    if (at->key.cache == cache) remove(at);
    at = next;
  }
}

void TileStore::set_limit(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  limit_ = bytes;
  shrink();
}

std::size_t TileStore::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void TileStore::remove(Order::iterator at) {
  bytes_ -= at->bytes;
  places_.erase(at->key);
  order_.erase(at);
}

void TileStore::shrink() {
  while (bytes_ > limit_ && order_.size() > 1) remove(std::prev(order_.end()));
}

}  // namespace mars
