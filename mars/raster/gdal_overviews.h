// Levels of a raster: its full resolution, and the overviews that its file has; and reading them by whole blocks of the
// file, each once as long as it is kept.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "mars/raster/gdal_grid.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/gdal_tiles.h"
#include "mars/sources/source.h"

namespace mars {

// Describes full resolution or one overview.
struct RasterLevel {
  int overview = -1;  // as GdalRaster::read() takes it
  PixelGrid grid;
  glm::dvec2 scale{1, 1};   // its pixels per pixel of the raster, by column and row
  double factor = 1;        // pixels of the raster per pixel of it
  int block_columns = 256;  // size of the blocks in which it is fetched: that of the file's, if they are tiles
  int block_rows = 256;

  // Return a position among its pixels, and among those of the raster.
  glm::dvec2 from_raster(const glm::dvec2& pixel) const { return (pixel + 0.5) * scale - 0.5; }
  glm::dvec2 to_raster(const glm::dvec2& pixel) const { return (pixel + 0.5) / scale - 0.5; }
};

// Returns full resolution and all overviews of the first band that have its proportions and type, the finest first.
// They are of full resolution alone where a mask or an alpha band marks pixels, since masks need not have overviews.
std::vector<RasterLevel> raster_levels(const GdalRaster& raster, bool is_masked);

// Returns the index of the coarsest level whose pixels are at most sqrt(2) times `factor` pixels of the raster wide.
// Images choose theirs in the same way.
std::size_t level_for(const std::vector<RasterLevel>& levels, double factor);

// Returns a cap around the pixels of a window of a level; all of the sphere where one has no place on it.
Cap cap_of(const Georeference& georeference, const RasterLevel& level, const PixelWindow& window);

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
