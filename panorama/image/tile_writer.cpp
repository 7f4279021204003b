#include "panorama/image/tile_writer.h"

#include <algorithm>
#include <utility>

namespace panorama {

TileWriter::TileWriter(std::filesystem::path path, const ImageLevel& level)
    : path_(std::move(path)), level_(level), tiff_(path_, "w8") {
  vpe::core::TiffLayout layout;
  layout.width_px = static_cast<std::uint32_t>(level.width_px);
  layout.height_px = static_cast<std::uint32_t>(level.height_px);
  layout.samples = 3;
  layout.compression = COMPRESSION_ADOBE_DEFLATE;
  layout.tile_width_px = static_cast<std::uint32_t>(level.tile_width_px);
  layout.tile_height_px = static_cast<std::uint32_t>(level.tile_height_px);
  // Speed counts more than size: the copies are made once and can be made again.
  const bool ok = tiff_.get() != nullptr && set_layout(tiff_.get(), layout) &&
                  TIFFSetField(tiff_.get(), TIFFTAG_ZIPQUALITY, 1) == 1;
  if (!ok) fail();
  rows_.resize(static_cast<std::size_t>(level.width_px) * static_cast<std::size_t>(level.tile_height_px));
  tile_.resize(static_cast<std::size_t>(level.tile_width_px) * static_cast<std::size_t>(level.tile_height_px));
}

void TileWriter::fail() const {
  throw vpe::base::file_error("write", path_, tiff_.words(), "check the free space and the permissions there");
}

void TileWriter::take(std::span<const vpe::base::Rgb> row) {
  std::copy(row.begin(), row.end(), rows_.begin() + kept_ * level_.width_px);
  if (++kept_ == level_.tile_height_px) write_tiles();
}

void TileWriter::write_tiles() {
  for (std::int64_t column = 0; column < level_.tile_columns(); ++column) {
    const std::int64_t begin = column * level_.tile_width_px;
    const std::int64_t count = std::min<std::int64_t>(level_.tile_width_px, level_.width_px - begin);
    std::fill(tile_.begin(), tile_.end(), vpe::base::Rgb{});
    for (std::int64_t y = 0; y < kept_; ++y) {
      std::copy_n(rows_.begin() + y * level_.width_px + begin, count, tile_.begin() + y * level_.tile_width_px);
    }
    const auto bytes = static_cast<tmsize_t>(tile_.size() * sizeof(vpe::base::Rgb));
    if (TIFFWriteEncodedTile(tiff_.get(), next_tile_++, tile_.data(), bytes) < 0) fail();
  }
  kept_ = 0;
}

void TileWriter::finish() {
  if (kept_ > 0) write_tiles();
  if (TIFFFlush(tiff_.get()) != 1) fail();
  tiff_.close();
}

}  // namespace panorama
