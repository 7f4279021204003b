// Images as files and as bytes: PNG and JPEG for colour, TIFF for range.
//
// Row 0 is the top; rows follow each other without gaps. Every writer is atomic (vpe/base/file.h). Functions
// throw FileError (files) or ImageError (bytes in memory), with what failed, the library's own words and what
// to do. All functions may be called from any thread; none depends on the locale.
//
// Typical usage:
//   const RgbImage image = read_image("a.png");
//   write_image("b.jpg", image.pixels, image.width, image.height, {.jpeg_quality = 95});
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "vpe/base/file.h"
#include "vpe/base/rgb.h"
#include "vpe/core/image/png_text.h"
#include "vpe/core/image/tiff_metadata.h"

namespace vpe::core {

inline constexpr int kMaxImageSide_px = 32768;
// Limits the images that readers accept by default, so that a small file cannot claim all memory.
inline constexpr std::int64_t kMaxReadPixels = std::int64_t{1} << 28;

// Reports bytes that cannot be encoded or decoded.
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
  // 1 to 100. Larger: closer to the image, larger files. Chroma has half the resolution below 90.
  int jpeg_quality = 90;
  // 1 to 9. Larger: smaller files, slower. On rendered images 3 takes 1.6 times as long as 1 for files a
  // twentieth smaller, 6 takes 3.3 times as long for an eighth smaller.
  int png_compression = 1;
  // kNone: fastest, largest files.
  TiffCompression tiff = TiffCompression::kDeflate;
  std::vector<PngText> png_texts = {};  // of RGB images
  TiffMetadata tiff_metadata = {};
};

// Returns whether write_image() knows the extension of a path: .png, .jpg or .jpeg, in any case.
bool is_image_path(const std::filesystem::path& path);

// Writes 8-bit sRGB in the format of the extension. Throws FileError, also for another extension, a size that
// does not fit the pixels, or a side over kMaxImageSide_px.
void write_image(const std::filesystem::path& path, std::span<const base::Rgb> pixels, int width, int height,
                 const ImageOptions& options = {});
// Writes 8-bit sRGB with alpha; PNG only.
void write_image(const std::filesystem::path& path, std::span<const Rgba> pixels, int width, int height,
                 const ImageOptions& options = {});

// Writes one float32 band (.tif, .tiff). Every value keeps its bits, infinities and NaN included.
void write_tiff(const std::filesystem::path& path, std::span<const float> values, int width, int height,
                const ImageOptions& options = {});

// Reads a PNG or JPEG; the format is found from the content. An alpha channel is dropped, 16 bits become 8.
// Throws FileError for a damaged file, and never returns a part of an image.
RgbImage read_image(const std::filesystem::path& path, std::int64_t max_pixels = kMaxReadPixels);

// Reads one float32 band that is stored in rows, as write_tiff() writes it.
FloatImage read_tiff(const std::filesystem::path& path, std::int64_t max_pixels = kMaxReadPixels);

// Encode and decode in memory. Throw ImageError.
std::vector<std::uint8_t> encode_jpeg(std::span<const base::Rgb> pixels, int width, int height, int quality);
std::vector<std::uint8_t> encode_png(std::span<const base::Rgb> pixels, int width, int height,
                                     int compression = 1);
std::vector<std::uint8_t> encode_png(std::span<const Rgba> pixels, int width, int height, int compression = 1);
RgbImage decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t max_pixels = kMaxReadPixels);
RgbImage decode_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels = kMaxReadPixels);

}  // namespace vpe::core
