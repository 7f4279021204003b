// Fetches a remote raster by whole blocks of its file, each once as long as it is kept.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "mars/raster/gdal_overviews.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/gdal_tiles.h"

namespace mars {

// Reads windows through blocks that all threads share: tiles of a raster overlap and need parts of up to four blocks,
// and GDAL keeps blocks for each handle alone. Any thread may call read().
template <class T>
class BlockReader {
 public:
  BlockReader(std::shared_ptr<const GdalRaster> raster, std::vector<RasterLevel> levels)
      : raster_(std::move(raster)), levels_(std::move(levels)) {}

  // Reads pixels of the first band at a level into rows that are `stride` apart. Throws SourceError.
  void read(std::size_t level, const PixelWindow& window, int stride, T* values) const {
    const RasterLevel& l = levels_[level];
    for (int row = window.row / l.block_rows; row * l.block_rows < window.row + window.rows; ++row) {
      for (int column = window.column / l.block_columns;
           column * l.block_columns < window.column + window.columns; ++column) {
        copy(*fetch({static_cast<int>(level), column, row}), window, stride, values);
      }
    }
  }

 private:
  struct Block {
    PixelWindow window;
    std::vector<T> values;
    std::size_t bytes() const { return sizeof(Block) + values.size() * sizeof(T); }
  };

  std::shared_ptr<const Block> fetch(const TileId& id) const {
    // A thread that needs what another one fetches waits for it.
    const auto number = static_cast<std::size_t>(id.level * 7 + id.row * 31 + id.column);
    const std::lock_guard lock(fetching_[number % fetching_.size()]);
    return blocks_.get(id, [this](const TileId& key) {
      const RasterLevel& l = levels_[static_cast<std::size_t>(key.level)];
      auto block = std::make_shared<Block>();
      const int column = key.column * l.block_columns;
      const int row = key.row * l.block_rows;
      block->window = {column, row, std::min(l.block_columns, l.grid.width - column),
                       std::min(l.block_rows, l.grid.height - row)};
      block->values.resize(static_cast<std::size_t>(block->window.columns) *
                           static_cast<std::size_t>(block->window.rows));
      raster_->read(1, l.overview, block->window, block->window.columns, block->values.data());
      return std::shared_ptr<const Block>(std::move(block));
    });
  }

  static void copy(const Block& block, const PixelWindow& window, int stride, T* values) {
    const PixelWindow& b = block.window;
    const int first_column = std::max(b.column, window.column);
    const int last_column = std::min(b.column + b.columns, window.column + window.columns);
    const int first_row = std::max(b.row, window.row);
    const int last_row = std::min(b.row + b.rows, window.row + window.rows);
    for (int row = first_row; row < last_row; ++row) {
      const T* from = block.values.data() + std::ptrdiff_t{row - b.row} * b.columns;
      T* to = values + std::ptrdiff_t{row - window.row} * stride;
      std::copy(from + (first_column - b.column), from + (last_column - b.column),
                to + (first_column - window.column));
    }
  }

  std::shared_ptr<const GdalRaster> raster_;
  std::vector<RasterLevel> levels_;
  mutable TileCache<Block> blocks_;
  mutable std::array<std::mutex, 64> fetching_;
};

}  // namespace mars
