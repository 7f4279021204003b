// Decoded pieces of rasters, kept while they are in use or fit a budget.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "mars/gdal_grid.h"

namespace mars {

// Tiles of kTileSide^2 pixels plus the next column and row, so that a 2x2 neighbourhood lies in one tile: the
// next tile's, the first column again where the raster wraps, or the last one again at its end.
inline constexpr int kTileSide = 256;
inline constexpr int kTileStride = kTileSide + 1;

struct TileId {
  int level = 0;
  int column = 0;
  int row = 0;
  bool operator==(const TileId&) const = default;
};

inline constexpr std::size_t kTileCacheBytes = std::size_t{256} << 20;

// Least-recently-used tiles up to a number of bytes. Tile needs `std::size_t bytes() const`. Tiles that are
// held live on outside. Two threads that miss the same tile at once both make it; the first one's is kept.
template <class Tile>
class TileCache {
 public:
  using Pointer = std::shared_ptr<const Tile>;

  explicit TileCache(std::size_t limit_bytes = kTileCacheBytes) : limit_bytes_(limit_bytes) {}

  template <class Make>
  Pointer get(const TileId& id, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = places_.find(id);
      if (found != places_.end()) {
        order_.splice(order_.begin(), order_, found->second);
        return found->second->second;
      }
    }
    Pointer made = make(id);
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(id);
    if (found != places_.end()) return found->second->second;
    order_.emplace_front(id, made);
    places_.emplace(id, order_.begin());
    bytes_ += made->bytes();
    while (bytes_ > limit_bytes_ && order_.size() > 1) {
      bytes_ -= order_.back().second->bytes();
      places_.erase(order_.back().first);
      order_.pop_back();
    }
    return made;
  }

 private:
  struct Hash {
    std::size_t operator()(const TileId& id) const {
      const auto key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.row)) << 32 |
                        static_cast<std::uint32_t>(id.column)) *
                           31 +
                       static_cast<std::uint64_t>(id.level);
      return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 7);
    }
  };
  using Order = std::list<std::pair<TileId, Pointer>>;

  std::size_t limit_bytes_;
  std::size_t bytes_ = 0;
  std::mutex mutex_;
  Order order_;
  std::unordered_map<TileId, typename Order::iterator, Hash> places_;
};

// The tiles a batch has just used, so that neighbouring posts cost no lock. For one thread and one level.
template <class Tile, class Fetch>
class TileCursor {
 public:
  TileCursor(int level, Fetch fetch) : level_(level), fetch_(std::move(fetch)) {}

  const Tile& at(int column, int row) {
    const int tile_column = column / kTileSide;
    const int tile_row = row / kTileSide;
    Slot& slot = slots_[static_cast<std::size_t>((tile_row & 3) * 4 + (tile_column & 3))];
    if (!slot.tile || slot.column != tile_column || slot.row != tile_row) {
      slot = {fetch_(TileId{level_, tile_column, tile_row}), tile_column, tile_row};
    }
    return *slot.tile;
  }

  static std::size_t offset(int column, int row) {
    return static_cast<std::size_t>((row % kTileSide) * kTileStride + column % kTileSide);
  }

 private:
  struct Slot {
    std::shared_ptr<const Tile> tile;
    int column = 0;
    int row = 0;
  };
  int level_;
  Fetch fetch_;
  std::array<Slot, 16> slots_;
};

// The part of a tile that lies inside the raster.
inline PixelWindow tile_window(const PixelGrid& grid, const TileId& id) {
  const int column = id.column * kTileSide;
  const int row = id.row * kTileSide;
  return {column, row, std::min(kTileStride, grid.width - column), std::min(kTileStride, grid.height - row)};
}

// Completes a tile at the raster's right and lower end, whose pixels of tile_window() are set, rows kTileStride
// apart: the next column is `next_column` (values of the raster's first column, where it wraps) or a copy of
// the last one, the next row a copy.
template <class T>
void complete_tile(const PixelWindow& window, const T* next_column, T* values) {
  if (window.columns < kTileStride) {
    for (int row = 0; row < window.rows; ++row) {
      T* line = values + std::ptrdiff_t{row} * kTileStride;
      line[window.columns] = next_column != nullptr ? next_column[row] : line[window.columns - 1];
    }
  }
  if (window.rows < kTileStride) {
    const T* last = values + std::ptrdiff_t{window.rows - 1} * kTileStride;
    std::copy(last, last + kTileStride, values + std::ptrdiff_t{window.rows} * kTileStride);
  }
}

}  // namespace mars
