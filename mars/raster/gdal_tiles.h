// Decoded tiles of rasters, kept while they are in use or fit into the budget that all rasters share.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "mars/raster/gdal_grid.h"
#include "vpe/base/lru_cache.h"

namespace mars {

// A tile holds kTileSide^2 pixels plus the next column and row, so that 2x2 neighbours lie in one tile. These
// are the next tile's first ones; where the raster wraps, its first column; at its end, a copy of the last
// ones.
inline constexpr int kTileSide = 256;
inline constexpr int kTileStride = kTileSide + 1;

struct TileId {
  int level = 0;
  int column = 0;
  int row = 0;
  bool operator==(const TileId&) const = default;
};

// Holds tiles of all rasters within one budget. The least recently used tiles leave first, so rasters no longer
// in use make room for others. A tile stays alive as long as somebody holds it. Any thread may call any member.
class TileStore {
 public:
  using Pointer = std::shared_ptr<const void>;
  struct Key {
    std::uint64_t cache = 0;
    TileId tile;
    bool operator==(const Key&) const = default;
  };

  explicit TileStore(std::size_t limit_bytes) : tiles_(limit_bytes, kEntryBytes) {}

  // Returns the store of the process; mars/raster/raster_memory.h sets its limit.
  static TileStore& common();

  // Returns a number that no other cache has, whatever the type of its tiles.
  static std::uint64_t next_cache();

  // Returns a tile and marks it as used, or returns null.
  Pointer find(const Key& key) { return tiles_.find(key); }
  // Returns the tile that the store now holds: an earlier one wins. The newest is kept whatever its size.
  Pointer insert(const Key& key, Pointer tile, std::size_t bytes) {
    return tiles_.insert(key, std::move(tile), bytes);
  }
  // Removes all tiles of a cache.
  void forget(std::uint64_t cache) {
    tiles_.erase_if([cache](const Key& key) { return key.cache == cache; });
  }
  void set_limit(std::size_t bytes) { tiles_.set_limit(bytes); }
  std::size_t bytes() const { return tiles_.bytes(); }

 private:
  struct Hash {
    std::size_t operator()(const Key& k) const {
      const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(k.tile.row)) << 32 |
                         static_cast<std::uint32_t>(k.tile.column);
      const auto key = (place * 31 + static_cast<std::uint64_t>(k.tile.level)) * 31 + k.cache;
      return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 7);
    }
  };
  static constexpr std::size_t kEntryBytes = 160;  // list and map nodes

  vpe::base::LruCache<Key, void, Hash> tiles_;
};

// Holds one raster's tiles in the common store. Tile needs `std::size_t bytes() const`. If two threads need the
// same absent tile at once, both make it and the first result is kept.
template <class Tile>
class TileCache {
 public:
  using Pointer = std::shared_ptr<const Tile>;

  TileCache() : number_(TileStore::next_cache()) {}
  ~TileCache() { store_.forget(number_); }
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  // Returns a tile, made by make(id) if it is absent.
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

// Holds the tiles that a batch has used last, so that neighbouring posts need no lock. Serves one thread and
// one level. fetch(TileId) returns a tile.
template <class Tile, class Fetch>
class TileCursor {
 public:
  TileCursor(int level, Fetch fetch) : level_(level), fetch_(std::move(fetch)) {}

  // Returns the tile that contains a pixel.
  const Tile& at(int column, int row) {
    const int tile_column = column / kTileSide;
    const int tile_row = row / kTileSide;
    if (last_ != nullptr && tile_column == last_column_ && tile_row == last_row_) return *last_;
    Slot& slot = slots_[static_cast<std::size_t>((tile_row & 3) * 4 + (tile_column & 3))];
    if (!slot.tile || slot.column != tile_column || slot.row != tile_row) {
      slot = {fetch_(TileId{level_, tile_column, tile_row}), tile_column, tile_row};
    }
    last_ = slot.tile.get();
    last_column_ = tile_column;
    last_row_ = tile_row;
    return *last_;
  }

  // Returns the index of a pixel in its tile.
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
  const Tile* last_ = nullptr;  // one of them
  int last_column_ = 0;
  int last_row_ = 0;
};

// Returns the part of a tile that lies inside the raster.
inline PixelWindow tile_window(const PixelGrid& grid, const TileId& id) {
  const int column = id.column * kTileSide;
  const int row = id.row * kTileSide;
  return {column, row, std::min(kTileStride, grid.width - column), std::min(kTileStride, grid.height - row)};
}

// Completes a tile at the right and lower end of the raster. The pixels of tile_window() must be set, in rows
// that are kTileStride apart. Sets the next column to `next_column` (the raster's first column, where it wraps)
// or, if that is null, to a copy of the last column; sets the next row to a copy of the last row.
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
