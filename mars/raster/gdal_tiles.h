// Decoded pieces of rasters, kept while they are in use or fit a budget that all rasters share.
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

#include "mars/raster/gdal_grid.h"

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

// Tiles of all rasters, least recently used ones leave first: a raster that is not asked for any more makes
// room for others. Tiles that are held live on outside. Any thread may call any member.
class TileStore {
 public:
  using Pointer = std::shared_ptr<const void>;
  struct Key {
    std::uint64_t cache = 0;
    TileId tile;
    bool operator==(const Key&) const = default;
  };

  explicit TileStore(std::size_t limit_bytes) : limit_(limit_bytes) {}
  static TileStore& common();  // of the process; see mars/raster/raster_memory.h

  // A number that no cache has yet, of whatever kind its tiles are.
  static std::uint64_t next_cache();

  Pointer find(const Key& key);
  // The tile that the store now holds: an earlier one wins. The newest is kept whatever its size.
  Pointer insert(const Key& key, Pointer tile, std::size_t bytes);
  void forget(std::uint64_t cache);
  void set_limit(std::size_t bytes);
  std::size_t bytes() const;

 private:
  struct Hash {
    std::size_t operator()(const Key& k) const {
      const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(k.tile.row)) << 32 |
                         static_cast<std::uint32_t>(k.tile.column);
      const auto key = (place * 31 + static_cast<std::uint64_t>(k.tile.level)) * 31 + k.cache;
      return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 7);
    }
  };
  struct Entry {
    Key key;
    Pointer tile;
    std::size_t bytes;
  };
  using Order = std::list<Entry>;
  static constexpr std::size_t kEntryBytes = 160;  // list and map nodes

  void remove(Order::iterator at);
  void shrink();

  mutable std::mutex mutex_;
  std::size_t limit_;
  std::size_t bytes_ = 0;
  Order order_;
  std::unordered_map<Key, Order::iterator, Hash> places_;
};

// One raster's tiles in the common store. Tile needs `std::size_t bytes() const`. Two threads that miss the
// same tile at once both make it; the first one's is kept.
template <class Tile>
class TileCache {
 public:
  using Pointer = std::shared_ptr<const Tile>;

  TileCache() : number_(TileStore::next_cache()) {}
  ~TileCache() { store_.forget(number_); }
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  template <class Make>
  Pointer get(const TileId& id, const Make& make) {
    const TileStore::Key key{number_, id};
    auto tile = store_.find(key);
    if (!tile) {
      Pointer made = make(id);
      const std::size_t bytes = made->bytes();
      tile = store_.insert(key, std::move(made), bytes);
    }
    return std::static_pointer_cast<const Tile>(tile);
  }

 private:
  TileStore& store_ = TileStore::common();
  std::uint64_t number_;
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
