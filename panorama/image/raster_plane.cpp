#include "panorama/image/raster_plane.h"

#include <cstring>
#include <utility>

#include "panorama/image/tiff_file.h"

namespace panorama {

namespace {

using vpe::base::file_error;

// Limits one tile or strip, which is decoded whole.
constexpr tmsize_t kMaxPartBytes = tmsize_t{1} << 28;

struct Layout {
  std::uint32_t width_px;
  std::uint32_t height_px;
  std::size_t bands;
  std::size_t value_bytes;
  bool is_tiled;
  std::uint32_t part_width_px;  // of a tile or strip
  std::uint32_t part_height_px;
};

Layout layout_of(const TiffFile& file) {
  Layout layout{};
  layout.width_px = file.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  layout.height_px = file.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  layout.bands = file.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto bits = file.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  layout.value_bytes = bits / 8U;
  const auto format = file.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const auto planes = file.field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  if ((bits != 32 && bits != 64) || format != SAMPLEFORMAT_IEEEFP || layout.bands < 1 ||
      (layout.bands > 1 && planes != PLANARCONFIG_CONTIG)) {
    throw file_error("read", file.path(), "its bands are not 32- or 64-bit floating point numbers side by side",
                     "convert it: gdal_translate -ot Float32 -co INTERLEAVE=PIXEL IN.tif OUT.tif");
  }
  layout.is_tiled = TIFFIsTiled(file.get()) != 0;
  layout.part_width_px = layout.is_tiled ? file.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : layout.width_px;
  layout.part_height_px = layout.is_tiled ? file.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0)
                                          : file.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, layout.height_px);
  if (layout.part_width_px < 1 || layout.part_height_px < 1) throw file.damaged();
  return layout;
}

double value_at(const std::uint8_t* bytes, std::size_t size) {
  if (size == sizeof(float)) {
    float value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  }
  double value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

RasterPlane::RasterPlane(std::filesystem::path path, std::int64_t width_px, std::int64_t height_px)
    : path_(std::move(path)) {
  const TiffFile file(path_);
  const Layout layout = layout_of(file);
  if (layout.width_px == width_px && layout.height_px == height_px) return;
  throw file_error("use", path_,
                   "it has " + std::to_string(layout.width_px) + "x" + std::to_string(layout.height_px) +
                       " pixels, the image " + std::to_string(width_px) + "x" + std::to_string(height_px),
                   "an auxiliary layer must have the image's size; remove it from the JSON or make it again");
}

std::vector<double> RasterPlane::at(std::int64_t column, std::int64_t row) const {
  const TiffFile file(path_);
  const Layout layout = layout_of(file);
  const auto x = static_cast<std::uint32_t>(column);
  const auto y = static_cast<std::uint32_t>(row);
  TIFF* tiff = file.get();
  const std::uint32_t number =
      layout.is_tiled ? TIFFComputeTile(tiff, x, y, 0, 0) : TIFFComputeStrip(tiff, y, 0);
  const tmsize_t bytes = layout.is_tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  if (bytes < 1 || bytes > kMaxPartBytes) {
    throw file_error("read", path_, "one of its tiles or strips takes " + std::to_string(bytes) + " bytes",
                     "convert it: gdal_translate -co TILED=YES IN.tif OUT.tif");
  }
  std::vector<std::uint8_t> part(static_cast<std::size_t>(bytes));
  const tmsize_t got = layout.is_tiled ? TIFFReadEncodedTile(tiff, number, part.data(), bytes)
                                       : TIFFReadEncodedStrip(tiff, number, part.data(), bytes);
  const std::size_t step = layout.bands * layout.value_bytes;
  const std::size_t place =
      (std::size_t{y % layout.part_height_px} * layout.part_width_px + x % layout.part_width_px) * step;
  if (got < 0 || place + step > static_cast<std::size_t>(got)) throw file.damaged();
  std::vector<double> values;
  for (std::size_t band = 0; band < layout.bands; ++band)
    values.push_back(value_at(part.data() + place + band * layout.value_bytes, layout.value_bytes));
  return values;
}

}  // namespace panorama
