// Images as files and as bytes: PNG and JPEG for colour, TIFF for range.
//
// Row 0 is the top; rows follow each other without gaps. Every writer is atomic (file.h). Functions
// throw FileError (files) or ImageError (bytes in memory): what failed, the library's own words, what to do.
// All may be called from any thread; none depends on the locale.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mars/sources/source.h"
#include "vpe/base/file.h"

namespace vpe::core {

inline constexpr int kMaxImageSide_px = 32768;
// Largest image that a reader accepts unless told otherwise: a small file must not claim all memory.
inline constexpr std::int64_t kMaxReadPixels = std::int64_t{1} << 28;

class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Rgba {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  std::uint8_t a = 255;
  bool operator==(const Rgba&) const = default;
};

template <class Pixel>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels;  // width * height
};
using RgbImage = Image<base::Rgb>;
using FloatImage = Image<float>;

enum class TiffCompression : std::uint8_t { kNone, kLzw, kDeflate };

struct ImageOptions {
  int jpeg_quality = 90;  // 1 to 100; chroma is halved below 90
  // 1 to 9. On rendered images 3 takes 1.6 times as long as 1 for files a twentieth smaller, 6 takes 3.3 times
  // as long for an eighth smaller.
  int png_compression = 1;
  TiffCompression tiff = TiffCompression::kDeflate;
};

// Whether write_image() knows the extension of a path: .png, .jpg or .jpeg, in any case.
bool is_image_path(const std::filesystem::path& path);

// 8-bit sRGB, in the format of the extension. Throws FileError, also for another extension, a size that does
// not fit the pixels, or a side over kMaxImageSide_px.
void write_image(const std::filesystem::path& path, std::span<const base::Rgb> pixels, int width, int height,
                 const ImageOptions& options = {});
// PNG only.
void write_image(const std::filesystem::path& path, std::span<const Rgba> pixels, int width, int height,
                 const ImageOptions& options = {});

// One float32 band (.tif, .tiff), every value kept to the bit, infinities and NaN included.
void write_tiff(const std::filesystem::path& path, std::span<const float> values, int width, int height,
                const ImageOptions& options = {});

// PNG or JPEG by content. An alpha channel is dropped, 16 bits become 8. A damaged file is an error, never a
// half image.
RgbImage read_image(const std::filesystem::path& path, std::int64_t max_pixels = kMaxReadPixels);

// One float32 band, stored in rows, as write_tiff() makes.
FloatImage read_tiff(const std::filesystem::path& path, std::int64_t max_pixels = kMaxReadPixels);

// The same in memory.
std::vector<std::uint8_t> encode_jpeg(std::span<const base::Rgb> pixels, int width, int height, int quality);
std::vector<std::uint8_t> encode_png(std::span<const base::Rgb> pixels, int width, int height,
                                     int compression = 1);
std::vector<std::uint8_t> encode_png(std::span<const Rgba> pixels, int width, int height, int compression = 1);
RgbImage decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t max_pixels = kMaxReadPixels);
RgbImage decode_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels = kMaxReadPixels);

}  // namespace vpe::core
