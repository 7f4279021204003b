#include "panorama/image/row_source.h"

#include <algorithm>

#include "panorama/image/tiff_tiles.h"

namespace panorama {

namespace {

class TiffRows : public RowSource {
 public:
  TiffRows(const TiffPage& page, std::size_t max_bytes) : tiles_({page}), level_(page.level) {
    const auto columns = static_cast<std::size_t>(level_.tile_columns());
    if (tile_bytes(level_) > max_bytes / columns) {
      throw vpe::base::file_error("read", page.file->path(),
                                  "a row of its tiles or strips does not fit into memory",
                                  "give more --memory, or convert it: gdal_translate -of COG IN.tif OUT.tif");
    }
    row_of_tiles_.resize(columns);
  }

  std::int64_t width_px() const override { return level_.width_px; }
  std::int64_t height_px() const override { return level_.height_px; }

  void read(std::span<vpe::base::Rgb> row) override {
    const std::int64_t in_tile = next_ % level_.tile_height_px;
    if (in_tile == 0) {
      for (auto& tile : row_of_tiles_) tile.reset();
      for (std::size_t n = 0; n < row_of_tiles_.size(); ++n)
        row_of_tiles_[n] = tiles_.read(0, static_cast<std::int64_t>(n), next_ / level_.tile_height_px);
    }
    const auto width = static_cast<std::size_t>(level_.tile_width_px);
    for (std::size_t n = 0; n < row_of_tiles_.size(); ++n) {
      const std::size_t count = std::min(width, row.size() - n * width);
      const vpe::base::Rgb* from = row_of_tiles_[n]->pixels.data() + static_cast<std::size_t>(in_tile) * width;
      std::copy_n(from, count, row.data() + n * width);
    }
    ++next_;
  }

 private:
  TiffTiles tiles_;
  ImageLevel level_;
  std::vector<std::shared_ptr<const Tile>> row_of_tiles_;
  std::int64_t next_ = 0;
};

}  // namespace

std::unique_ptr<RowSource> open_rows(const std::filesystem::path& path, ImageFileFormat format,
                                     std::size_t max_bytes) {
  switch (format) {
    case ImageFileFormat::kPng: return open_png_rows(path);
    case ImageFileFormat::kJpeg: return open_jpeg_rows(path);
    case ImageFileFormat::kTiff: return std::make_unique<TiffRows>(list_pages(path).front(), max_bytes);
    case ImageFileFormat::kOther: break;
  }
  throw vpe::base::file_error("read", path, "it is neither PNG, JPEG nor TIFF", "convert it to one of them");
}

}  // namespace panorama
