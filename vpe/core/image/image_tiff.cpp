#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>

#include "vpe/core/image/image.h"
#include "vpe/core/image/image_checks.h"
#include "vpe/core/image/tiff_handle.h"

namespace vpe::core {

namespace {

constexpr char kDiskAdvice[] = "check the free space and the permissions there";
constexpr char kTiffAdvice[] = "the file is damaged or was not made by write_tiff";
constexpr std::size_t kStripBytes = std::size_t{1} << 18;
// Classic TIFF holds 4 GiB; leave room for what compression may add.
constexpr std::size_t kMaxClassicBytes = std::size_t{3} << 30;

std::uint16_t tag_of(TiffCompression compression) {
  switch (compression) {
    case TiffCompression::kNone: return COMPRESSION_NONE;
    case TiffCompression::kLzw: return COMPRESSION_LZW;
    case TiffCompression::kDeflate: return COMPRESSION_ADOBE_DEFLATE;
  }
  return COMPRESSION_NONE;
}

bool write_rows(TIFF* tiff, std::span<const float> values, int width, int height, const ImageOptions& options) {
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows_a_strip = std::max(std::size_t{1}, kStripBytes / (columns * sizeof(float)));
  TiffLayout layout;
  layout.width_px = static_cast<std::uint32_t>(width);
  layout.height_px = static_cast<std::uint32_t>(height);
  layout.bits = 32;
  layout.compression = tag_of(options.tiff);
  layout.tile_height_px = static_cast<std::uint32_t>(rows_a_strip);
  bool ok = set_layout(tiff, layout) && set_metadata(tiff, options.tiff_metadata);
  // The library changes the rows that it is given.
  std::vector<float> strip;
  std::uint32_t index = 0;
  for (std::size_t begin = 0; ok && begin < values.size(); begin += rows_a_strip * columns, ++index) {
    const std::span<const float> rows =
        values.subspan(begin, std::min(rows_a_strip * columns, values.size() - begin));
    strip.assign(rows.begin(), rows.end());
    ok = TIFFWriteEncodedStrip(tiff, index, strip.data(), static_cast<tmsize_t>(rows.size_bytes())) >= 0;
  }
  return ok && TIFFFlush(tiff) == 1;
}

}  // namespace

void write_tiff(const std::filesystem::path& path, std::span<const float> values, int width, int height,
                const ImageOptions& options) {
  try {
    check_image_size(values.size(), width, height);
  } catch (const ImageError& e) {
    throw base::FileError("cannot write '" + path.string() + "': " + e.what());
  }
  base::OutputFile file(path);
  TiffHandle tiff(file.stream(), path, values.size_bytes() > kMaxClassicBytes ? "w8" : "w");
  if (tiff.get() == nullptr || !write_rows(tiff.get(), values, width, height, options)) {
    throw base::file_error("write", path, tiff.words(), kDiskAdvice);
  }
  tiff.close();
  file.commit();
}

FloatImage read_tiff(const std::filesystem::path& path, std::int64_t max_pixels) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
  if (stream == nullptr) {
    throw base::file_error("read", path, std::strerror(errno), "check the name and the permissions");
  }
  const TiffHandle tiff(stream.get(), path, "r");
  if (tiff.get() == nullptr) throw base::file_error("read", path, tiff.words(), kTiffAdvice);

  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 0;
  std::uint16_t samples = 0;
  std::uint16_t format = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &format);
  if (bits != 32 || samples != 1 || format != SAMPLEFORMAT_IEEEFP || TIFFIsTiled(tiff.get()) != 0) {
    throw base::file_error("read", path, "not one float32 band in rows",
                           "convert it, e.g. gdal_translate -ot Float32");
  }
  try {
    check_read_size(width, height, max_pixels);
  } catch (const ImageError& e) {
    throw base::FileError("cannot read '" + path.string() + "': " + e.what());
  }
  FloatImage image{static_cast<int>(width), static_cast<int>(height), {}};
  image.pixels.resize(std::size_t{width} * height);
  for (std::uint32_t row = 0; row < height; ++row) {
    if (TIFFReadScanline(tiff.get(), image.pixels.data() + std::size_t{row} * width, row) != 1) {
      throw base::file_error("read", path, tiff.words(), kTiffAdvice);
    }
  }
  return image;
}

}  // namespace vpe::core
