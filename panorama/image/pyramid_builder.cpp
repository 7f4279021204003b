#include "panorama/image/pyramid_builder.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "panorama/image/tile_writer.h"

namespace panorama {

namespace {

namespace fs = std::filesystem;

std::string level_name(int level) { return "level-" + std::to_string(level) + ".tif"; }

// Removes the folder with everything in it unless it has been renamed.
class DraftFolder {
 public:
  explicit DraftFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) throw vpe::base::file_error("write", path_, error.message(), "check the permissions there");
  }
  ~DraftFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  DraftFolder(const DraftFolder&) = delete;
  DraftFolder& operator=(const DraftFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

class MemoryTiles : public TileSource {
 public:
  explicit MemoryTiles(std::vector<std::shared_ptr<const Tile>> tiles) : tiles_(std::move(tiles)) {
    for (const auto& tile : tiles_)
      levels_.push_back({tile->width_px, tile->height_px, tile->width_px, tile->height_px});
  }
  const std::vector<ImageLevel>& levels() const override { return levels_; }
  std::shared_ptr<const Tile> read(int level, std::int64_t /*column*/, std::int64_t /*row*/) const override {
    return tiles_[static_cast<std::size_t>(level)];
  }

 private:
  std::vector<std::shared_ptr<const Tile>> tiles_;
  std::vector<ImageLevel> levels_;
};

}  // namespace

PyramidBuilder::PyramidBuilder(std::int64_t width_px, std::int64_t height_px, const MakeSink& make) {
  for (int level = 0;; ++level) {
    sinks_.push_back(make(level, width_px, height_px));
    if (std::max(width_px, height_px) <= kCoarsestSide_px) return;
    const std::size_t next = sinks_.size();
    downsamplers_.push_back(std::make_unique<BoxDownsampler>(
        width_px, height_px, [this, next](std::span<const vpe::base::Rgb> row) { pass(next, row); }));
    width_px = half_px(width_px);
    height_px = half_px(height_px);
  }
}

void PyramidBuilder::pass(std::size_t level, std::span<const vpe::base::Rgb> row) {
  if (sinks_[level]) sinks_[level](row);
  if (level < downsamplers_.size()) downsamplers_[level]->take(row);
}

std::unique_ptr<TileSource> memory_pyramid(RowSource& rows) {
  std::vector<std::shared_ptr<Tile>> tiles;
  PyramidBuilder pyramid(
      rows.width_px(), rows.height_px(),
      [&tiles](int /*level*/, std::int64_t width_px, std::int64_t height_px) {
        auto tile = std::make_shared<Tile>();
        tile->width_px = static_cast<int>(width_px);
        tile->height_px = static_cast<int>(height_px);
        tile->pixels.reserve(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
        tiles.push_back(tile);
        return [tile = tile.get()](std::span<const vpe::base::Rgb> row) {
          tile->pixels.insert(tile->pixels.end(), row.begin(), row.end());
        };
      });
  std::vector<vpe::base::Rgb> row(static_cast<std::size_t>(rows.width_px()));
  for (std::int64_t y = 0; y < rows.height_px(); ++y) {
    rows.read(row);
    pyramid.take(row);
  }
  return std::make_unique<MemoryTiles>(std::vector<std::shared_ptr<const Tile>>(tiles.begin(), tiles.end()));
}

void write_pyramid(const fs::path& folder, RowSource& rows, int first_level, std::size_t max_bytes,
                   const TiledImageProgress& progress) {
  // Each level keeps a row of its tiles; all smaller ones together as much as the first.
  const auto row_bytes = sizeof(vpe::base::Rgb) * static_cast<std::size_t>(rows.width_px() >> first_level);
  int tile_height_px = 256;
  while (tile_height_px > 16 && 2 * row_bytes * static_cast<std::size_t>(tile_height_px) > max_bytes)
    tile_height_px /= 2;
  const DraftFolder draft(folder.string() + "." + std::to_string(::getpid()) + ".tmp");
  std::vector<std::unique_ptr<TileWriter>> writers;
  PyramidBuilder pyramid(
      rows.width_px(), rows.height_px(),
      [&](int level, std::int64_t width_px, std::int64_t height_px) -> PyramidBuilder::Sink {
        if (level < first_level) return {};
        writers.push_back(std::make_unique<TileWriter>(draft.path() / level_name(level),
                                                       ImageLevel{width_px, height_px, 256, tile_height_px}));
        return [writer = writers.back().get()](std::span<const vpe::base::Rgb> row) { writer->take(row); };
      });
  std::vector<vpe::base::Rgb> row(static_cast<std::size_t>(rows.width_px()));
  for (std::int64_t y = 0; y < rows.height_px(); ++y) {
    if (progress && y % 64 == 0) progress(static_cast<double>(y) / static_cast<double>(rows.height_px()));
    rows.read(row);
    pyramid.take(row);
  }
  for (auto& writer : writers) writer->finish();
  writers.clear();
  std::error_code error;
  fs::rename(draft.path(), folder, error);
  // Another process may have made it first.
  if (error && !fs::is_directory(folder))
    throw vpe::base::file_error("write", folder, error.message(), "check the permissions there");
}

std::vector<TiffPage> pyramid_pages(const fs::path& folder) {
  std::vector<TiffPage> pages;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".tif") pages.push_back(list_pages(entry->path()).front());
  }
  std::sort(pages.begin(), pages.end(),
            [](const TiffPage& a, const TiffPage& b) { return a.level.width_px > b.level.width_px; });
  return pages;
}

}  // namespace panorama
