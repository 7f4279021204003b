#include "panorama/page/band_reader.h"

#include <cstring>

namespace panorama {

namespace {

// Limits what one reader keeps: a row of tiles of an image of 10 000 columns and two bands.
constexpr std::size_t kKeptBytes = std::size_t{64} << 20;
constexpr tmsize_t kMostPartBytes = tmsize_t{1} << 28;

}  // namespace

BandReader::BandReader(const std::filesystem::path& path) : file_(path) {
  bands_ = file_.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  value_bytes_ = file_.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 32) / 8U;
  const auto width_px = file_.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const auto height_px = file_.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  is_tiled_ = TIFFIsTiled(file_.get()) != 0;
  part_width_px_ = is_tiled_ ? file_.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : width_px;
  part_height_px_ = is_tiled_ ? file_.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0)
                              : file_.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, height_px);
  if (part_width_px_ < 1 || part_height_px_ < 1 || bands_ < 1 || (value_bytes_ != 4 && value_bytes_ != 8))
    throw file_.damaged();
}

const BandReader::Part& BandReader::part(std::uint32_t number) {
  if (const auto found = parts_.find(number); found != parts_.end()) return found->second;
  TIFF* tiff = file_.get();
  const tmsize_t bytes = is_tiled_ ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  if (bytes < 1 || bytes > kMostPartBytes) throw file_.damaged();
  if (part_bytes_ + static_cast<std::size_t>(bytes) > kKeptBytes) {
    parts_.clear();
    part_bytes_ = 0;
  }
  Part data(static_cast<std::size_t>(bytes));
  const tmsize_t got = is_tiled_ ? TIFFReadEncodedTile(tiff, number, data.data(), bytes)
                                 : TIFFReadEncodedStrip(tiff, number, data.data(), bytes);
  if (got < 0) throw file_.damaged();
  data.resize(static_cast<std::size_t>(got));
  part_bytes_ += data.size();
  return parts_.emplace(number, std::move(data)).first->second;
}

void BandReader::read_row(std::int64_t x, std::int64_t y, std::int64_t step, std::int64_t count, double* out) {
  const std::size_t pixel_bytes = bands_ * value_bytes_;
  const auto row = static_cast<std::uint32_t>(y);
  const Part* data = nullptr;
  std::uint32_t number = 0;
  for (std::int64_t n = 0; n < count; ++n) {
    const auto column = static_cast<std::uint32_t>(x + step * n);
    const std::uint32_t wanted =
        is_tiled_ ? TIFFComputeTile(file_.get(), column, row, 0, 0) : TIFFComputeStrip(file_.get(), row, 0);
    if (data == nullptr || wanted != number) {
      data = &part(wanted);
      number = wanted;
    }
    const std::size_t place =
        (std::size_t{row % part_height_px_} * part_width_px_ + column % part_width_px_) * pixel_bytes;
    if (place + pixel_bytes > data->size()) throw file_.damaged();
    for (std::size_t band = 0; band < bands_; ++band) {
      const std::uint8_t* bytes = data->data() + place + band * value_bytes_;
      if (value_bytes_ == sizeof(float)) {
        float value = 0;
        std::memcpy(&value, bytes, sizeof value);
        *out++ = static_cast<double>(value);
      } else {
        std::memcpy(out++, bytes, sizeof(double));
      }
    }
  }
}

}  // namespace panorama
