#include "vpe/core/image/image.h"

#include <algorithm>
#include <array>

#include "vpe/core/image/image_checks.h"

namespace vpe::core {

namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 31;

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return extension;
}

bool is_png(const std::filesystem::path& path) { return lower_extension(path) == ".png"; }
bool is_jpeg(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".jpg" || extension == ".jpeg";
}

// Runs a codec, and adds the name of the file to its errors.
template <class Codec>
auto with_path(const char* operation, const std::filesystem::path& path, const Codec& codec) {
  try {
    return codec();
  } catch (const ImageError& e) {
    throw base::FileError(std::string("cannot ") + operation + " '" + path.string() + "': " + e.what());
  }
}

std::string size_text(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

void check_image_size(std::size_t pixels, int width, int height) {
  if (width < 1 || height < 1 || width > kMaxImageSide_px || height > kMaxImageSide_px) {
    throw ImageError("image of " + size_text(width, height) + " pixels: each side must be 1 to " +
                     std::to_string(kMaxImageSide_px));
  }
  if (pixels != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw ImageError("image of " + size_text(width, height) + " pixels given as " + std::to_string(pixels));
  }
}

void check_read_size(std::uint32_t width, std::uint32_t height, std::int64_t max_pixels) {
  constexpr std::uint32_t kMaxSide = kMaxImageSide_px;
  const bool fits = width >= 1 && height >= 1 && width <= kMaxSide && height <= kMaxSide &&
                    std::int64_t{width} * height <= max_pixels;
  if (fits) return;
  throw ImageError("image of " + size_text(width, height) + " pixels: each side must be 1 to " +
                   std::to_string(kMaxImageSide_px) + ", all together at most " + std::to_string(max_pixels) +
                   "; make it smaller");
}

bool is_image_path(const std::filesystem::path& path) { return is_png(path) || is_jpeg(path); }

void write_image(const std::filesystem::path& path, std::span<const base::Rgb> pixels, int width, int height,
                 const ImageOptions& options) {
  if (!is_image_path(path)) {
    throw base::file_error("write", path, "no known image extension",
                           "let the name end in .png, .jpg or .jpeg");
  }
  base::write_file(path, with_path("write", path, [&] {
                     if (!is_png(path)) return encode_jpeg(pixels, width, height, options.jpeg_quality);
                     std::vector<std::uint8_t> png = encode_png(pixels, width, height, options.png_compression);
                     return options.png_texts.empty() ? png : with_png_text(png, options.png_texts);
                   }));
}

void write_image(const std::filesystem::path& path, std::span<const Rgba> pixels, int width, int height,
                 const ImageOptions& options) {
  if (!is_png(path)) {
    throw base::file_error("write", path, "an image with alpha fits PNG only", "let the name end in .png");
  }
  base::write_file(path, with_path("write", path,
                                   [&] { return encode_png(pixels, width, height, options.png_compression); }));
}

RgbImage read_image(const std::filesystem::path& path, std::int64_t max_pixels) {
  const std::vector<std::uint8_t> bytes = base::read_file(path, kMaxFileBytes);
  constexpr std::array<std::uint8_t, 4> kPngSignature{0x89, 'P', 'N', 'G'};
  constexpr std::array<std::uint8_t, 2> kJpegSignature{0xFF, 0xD8};
  const auto starts_with = [&bytes](std::span<const std::uint8_t> signature) {
    return bytes.size() >= signature.size() && std::equal(signature.begin(), signature.end(), bytes.begin());
  };
  return with_path("read", path, [&] {
    if (starts_with(kPngSignature)) return decode_png(bytes, max_pixels);
    if (starts_with(kJpegSignature)) return decode_jpeg(bytes, max_pixels);
    throw ImageError("neither PNG nor JPEG; convert it to one of them");
  });
}

}  // namespace vpe::core
