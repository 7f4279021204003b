#include "panorama/image/tiff_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "panorama/image/image_limits.h"

namespace panorama {

namespace {

constexpr char kConvert[] = "convert it: gdal_translate -ot Byte -expand rgb -co TILED=YES IN.tif OUT.tif";
constexpr int kMaxPages = 64;

std::string unreadable(const TiffFile& file) {
  const auto bits = file.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  const auto samples = file.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  const auto format = file.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const auto planes = file.field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  const auto meaning = file.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  const auto compression = file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if ((bits != 8 && bits != 16) || format != SAMPLEFORMAT_UINT)
    return "its samples are not whole numbers of 8 or 16 bits";
  if (samples > 1 && planes != PLANARCONFIG_CONTIG) return "its colours lie in planes of their own";
  const bool is_jpeg_colour = meaning == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG;
  const bool is_colour = samples >= 3 && (meaning == PHOTOMETRIC_RGB || is_jpeg_colour);
  const bool is_grey = samples <= 2 && meaning == PHOTOMETRIC_MINISBLACK;
  if (!is_colour && !is_grey) return "its colours are neither grey nor RGB";
  if (TIFFIsCODECConfigured(compression) == 0) return "its compression is not known here";
  return {};
}

TiffPage page_of(const std::shared_ptr<const TiffFile>& opened) {
  const TiffFile& file = *opened;
  TiffPage page;
  page.file = opened;
  page.directory = TIFFCurrentDirOffset(file.get());
  page.is_tiled = TIFFIsTiled(file.get()) != 0;
  const auto width_px = file.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const auto height_px = file.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  std::uint32_t tile_width_px = width_px;
  std::uint32_t tile_height_px = 0;
  if (page.is_tiled) {
    tile_width_px = file.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
    tile_height_px = file.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
  } else {
    tile_height_px = std::min(file.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, height_px), height_px);
  }
  constexpr auto kMaxSide = static_cast<std::uint32_t>(kMaxSide_px);
  for (const std::uint32_t side : {width_px, height_px, tile_width_px, tile_height_px}) {
    if (side >= 1 && side <= kMaxSide) continue;
    throw vpe::base::file_error("read", file.path(),
                                "a side of it or of its tiles has " + std::to_string(side) + " pixels",
                                "sides of 1 to " + std::to_string(kMaxSide) + " are read");
  }
  page.level = {width_px, height_px, static_cast<int>(tile_width_px), static_cast<int>(tile_height_px)};
  return page;
}

// Returns whether a level is reduced by the same factor in both directions, as far as rounding shows it.
bool is_reduced(const ImageLevel& full, const ImageLevel& level) {
  if (level.width_px >= full.width_px || level.height_px > full.height_px) return false;
  const double factor = static_cast<double>(full.width_px) / static_cast<double>(level.width_px);
  const double rows = static_cast<double>(full.height_px) / factor;
  return std::abs(rows - static_cast<double>(level.height_px)) <= 1.5;
}

void add_reduced(const std::shared_ptr<const TiffFile>& opened, std::vector<TiffPage>& pages) {
  const TiffFile& file = *opened;
  const auto kind = file.field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0);
  if ((kind & FILETYPE_REDUCEDIMAGE) == 0 || (kind & FILETYPE_MASK) != 0 || !unreadable(file).empty()) return;
  const TiffPage page = page_of(opened);
  if (is_reduced(pages.front().level, page.level)) pages.push_back(page);
}

vpe::base::Rgb pixel_at(const std::uint8_t* bytes, int samples, int bytes_a_sample) {
  const auto sample = [&](int n) {
    if (bytes_a_sample == 1) return bytes[n];
    // The library has converted them to the machine's order of bytes.
    std::uint16_t value = 0;
    std::copy_n(bytes + 2 * n, 2, reinterpret_cast<std::uint8_t*>(&value));
    return static_cast<std::uint8_t>((value * 255U + 32767U) / 65535U);
  };
  if (samples < 3) return {sample(0), sample(0), sample(0)};
  return {sample(0), sample(1), sample(2)};
}

}  // namespace

std::size_t tile_bytes(const ImageLevel& level) {
  return sizeof(vpe::base::Rgb) * static_cast<std::size_t>(level.tile_width_px) *
         static_cast<std::size_t>(level.tile_height_px);
}

std::vector<TiffPage> list_pages(const std::filesystem::path& path) {
  const auto opened = std::make_shared<const TiffFile>(path);
  const TiffFile& file = *opened;
  if (const std::string trouble = unreadable(file); !trouble.empty())
    throw vpe::base::file_error("read", path, trouble, kConvert);
  std::vector<TiffPage> pages{page_of(opened)};
  std::uint16_t below = 0;
  const std::uint64_t* offsets = nullptr;
  std::vector<std::uint64_t> children;
  if (TIFFGetField(file.get(), TIFFTAG_SUBIFD, &below, &offsets) == 1 && offsets != nullptr)
    children.assign(offsets, offsets + std::min<int>(below, kMaxPages));
  for (int n = 0; n < kMaxPages && TIFFReadDirectory(file.get()) == 1; ++n) add_reduced(opened, pages);
  for (const std::uint64_t offset : children) {
    if (TIFFSetSubDirectory(file.get(), offset) == 1) add_reduced(opened, pages);
  }
  std::stable_sort(pages.begin(), pages.end(),
                   [](const TiffPage& a, const TiffPage& b) { return a.level.width_px > b.level.width_px; });
  const auto same = [](const TiffPage& a, const TiffPage& b) { return a.level.width_px == b.level.width_px; };
  pages.erase(std::unique(pages.begin(), pages.end(), same), pages.end());
  return pages;
}

TiffTiles::TiffTiles(std::vector<TiffPage> pages) : pages_(std::move(pages)) {
  for (const TiffPage& page : pages_) {
    levels_.push_back(page.level);
    // A handle whose reading failed is closed: what it had begun to read is unknown.
    handles_.emplace_back([&page] { return open(page); },
                          vpe::base::ObjectPoolOptions<Handle>{.discard_on_exception = true});
  }
}

std::unique_ptr<TiffTiles::Handle> TiffTiles::open(const TiffPage& page) {
  auto handle = std::make_unique<Handle>(*page.file);
  TIFF* tiff = handle->file.get();
  if (TIFFSetSubDirectory(tiff, page.directory) != 1) throw handle->file.damaged();
  if (handle->file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG)
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  return handle;
}

std::shared_ptr<const Tile> TiffTiles::read(int level, std::int64_t column, std::int64_t row) const {
  const auto index = static_cast<std::size_t>(level);
  const ImageLevel& size = levels_[index];
  const auto handle = handles_[index].acquire();
  TIFF* tiff = handle->file.get();
  const auto number = static_cast<std::uint32_t>(row * size.tile_columns() + column);
  auto tile = std::make_shared<Tile>();
  tile->width_px = size.tile_width_px;
  tile->height_px = size.tile_height_px;
  tile->pixels.resize(tile_bytes(size) / sizeof(vpe::base::Rgb));
  int failed = 0;
  const std::uint64_t stored = TIFFGetStrileByteCountWithErr(tiff, number, &failed);
  if (failed != 0) throw handle->file.damaged();
  if (stored > 0) {
    const tmsize_t bytes = pages_[index].is_tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
    const int samples = handle->file.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    const int sample_bytes = handle->file.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 8) / 8;
    const auto step = static_cast<std::size_t>(samples * sample_bytes);
    if (bytes < 1 || static_cast<std::size_t>(bytes) / step < tile->pixels.size()) throw handle->file.damaged();
    handle->bytes.assign(static_cast<std::size_t>(bytes), 0);
    const tmsize_t got = pages_[index].is_tiled
                             ? TIFFReadEncodedTile(tiff, number, handle->bytes.data(), bytes)
                             : TIFFReadEncodedStrip(tiff, number, handle->bytes.data(), bytes);
    if (got < 0) throw handle->file.damaged();
    for (std::size_t n = 0; n < tile->pixels.size(); ++n)
      tile->pixels[n] = pixel_at(handle->bytes.data() + n * step, samples, sample_bytes);
  }
  return tile;
}

}  // namespace panorama
