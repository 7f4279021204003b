#include "panorama/image/raster_plane.h"

#include <cstring>
#include <unordered_map>
#include <utility>

#include "panorama/image/tiff_file.h"
#include "vpe/base/lru_cache.h"

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

// Names a tile or strip, and the place of a pixel in it.
struct PartPlace {
  std::uint32_t part = 0;
  std::size_t byte = 0;
};

PartPlace part_place(const TiffFile& file, const Layout& layout, std::int64_t column, std::int64_t row) {
  const auto x = static_cast<std::uint32_t>(column);
  const auto y = static_cast<std::uint32_t>(row);
  const std::uint32_t part =
      layout.is_tiled ? TIFFComputeTile(file.get(), x, y, 0, 0) : TIFFComputeStrip(file.get(), y, 0);
  const std::size_t pixel =
      std::size_t{y % layout.part_height_px} * layout.part_width_px + x % layout.part_width_px;
  return {part, pixel * layout.bands * layout.value_bytes};
}

std::vector<std::uint8_t> read_part(const TiffFile& file, const Layout& layout, std::uint32_t number) {
  TIFF* tiff = file.get();
  const tmsize_t bytes = layout.is_tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  if (bytes < 1 || bytes > kMaxPartBytes) {
    throw file_error("read", file.path(),
                     "one of its tiles or strips takes " + std::to_string(bytes) + " bytes",
                     "convert it: gdal_translate -co TILED=YES IN.tif OUT.tif");
  }
  std::vector<std::uint8_t> part(static_cast<std::size_t>(bytes));
  const tmsize_t got = layout.is_tiled ? TIFFReadEncodedTile(tiff, number, part.data(), bytes)
                                       : TIFFReadEncodedStrip(tiff, number, part.data(), bytes);
  if (got < 0) throw file.damaged();
  part.resize(static_cast<std::size_t>(got));
  return part;
}

// Throws unless a layer has the size of its image.
void check_size(const TiffFile& file, const Layout& layout, std::int64_t width_px, std::int64_t height_px) {
  if (layout.width_px == width_px && layout.height_px == height_px) return;
  throw file_error("use", file.path(),
                   "it has " + std::to_string(layout.width_px) + "x" + std::to_string(layout.height_px) +
                       " pixels, the image " + std::to_string(width_px) + "x" + std::to_string(height_px),
                   "an auxiliary layer must have the image's size; remove it from the JSON or make it again");
}

}  // namespace

RasterPlane::RasterPlane(std::filesystem::path path, std::int64_t width_px, std::int64_t height_px)
    : path_(std::move(path)) {
  const TiffFile file(path_);
  check_size(file, layout_of(file), width_px, height_px);
}

std::vector<double> RasterPlane::at(std::int64_t column, std::int64_t row) const {
  const TiffFile file(path_);
  const Layout layout = layout_of(file);
  const PartPlace place = part_place(file, layout, column, row);
  const std::vector<std::uint8_t> part = read_part(file, layout, place.part);
  if (place.byte + layout.bands * layout.value_bytes > part.size()) throw file.damaged();
  std::vector<double> values;
  for (std::size_t band = 0; band < layout.bands; ++band)
    values.push_back(value_at(part.data() + place.byte + band * layout.value_bytes, layout.value_bytes));
  return values;
}

struct PlaneReader::State {
  using Part = vpe::base::LruList<std::pair<std::uint32_t, std::vector<std::uint8_t>>>;

  State(std::filesystem::path path, std::size_t budget) : file(std::move(path)), budget_bytes(budget) {}

  const std::vector<std::uint8_t>& part(std::uint32_t number) {
    if (const auto known = index.find(number); known != index.end()) {
      parts.touch(known->second);
    } else {
      std::vector<std::uint8_t> read = read_part(file, layout, number);
      const std::size_t bytes = read.size();
      index[number] = parts.add({number, std::move(read)}, bytes);
      for (const auto& gone : parts.trim(budget_bytes)) index.erase(gone.value.first);
    }
    return parts.begin()->value.second;
  }

  TiffFile file;
  Layout layout{};
  std::size_t budget_bytes;
  Part parts;
  std::unordered_map<std::uint32_t, Part::Handle> index;
};

PlaneReader::PlaneReader(std::filesystem::path path, std::int64_t width_px, std::int64_t height_px,
                         std::size_t budget_bytes)
    : state_(std::make_unique<State>(std::move(path), budget_bytes)) {
  state_->layout = layout_of(state_->file);
  check_size(state_->file, state_->layout, width_px, height_px);
}
PlaneReader::~PlaneReader() = default;
PlaneReader::PlaneReader(PlaneReader&&) noexcept = default;
PlaneReader& PlaneReader::operator=(PlaneReader&&) noexcept = default;

double PlaneReader::at(std::int64_t column, std::int64_t row) {
  const PartPlace place = part_place(state_->file, state_->layout, column, row);
  const std::vector<std::uint8_t>& part = state_->part(place.part);
  if (place.byte + state_->layout.value_bytes > part.size()) throw state_->file.damaged();
  return value_at(part.data() + place.byte, state_->layout.value_bytes);
}

}  // namespace panorama
