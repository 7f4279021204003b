#include "objects/reader/texture_image.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <string>

#include "objects/reader/refusal.h"
#include "vpe/core/image/image.h"

namespace objects {

namespace {

constexpr std::array<std::uint8_t, 8> kPngMagic = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<std::uint8_t, 3> kJpegMagic = {0xff, 0xd8, 0xff};

template <class Magic>
bool starts_with(std::span<const std::uint8_t> bytes, const Magic& magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(this); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

Texture decode_png(std::span<const std::uint8_t> bytes, std::size_t most_texels) {
  PngImage image;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    throw Refusal("is a damaged PNG: " + std::string(image.message));
  constexpr std::uint32_t kMostSide = vpe::core::kMaxImageSide_px;
  const std::size_t texels = std::size_t{image.width} * image.height;
  if (texels == 0 || image.width > kMostSide || image.height > kMostSide || texels > most_texels)
    throw Refusal("has " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                      " pixels, which are too many",
                  "make the image smaller");
  image.format = PNG_FORMAT_RGBA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  Texture texture{static_cast<int>(image.width), static_cast<int>(image.height), std::vector<Rgba>(texels)};
  if (png_image_finish_read(&image, nullptr, texture.texels.data(), 0, nullptr) == 0)
    throw Refusal("is a damaged PNG: " + std::string(image.message));
  return texture;
}

Texture decode_jpeg(std::span<const std::uint8_t> bytes, std::size_t most_texels) {
  try {
    const vpe::core::RgbImage image = vpe::core::decode_jpeg(bytes, static_cast<std::int64_t>(most_texels));
    Texture texture{image.width, image.height, {}};
    texture.texels.reserve(image.pixels.size());
    for (const vpe::base::Rgb& p : image.pixels) texture.texels.push_back({p.r, p.g, p.b, 255});
    return texture;
  } catch (const vpe::core::ImageError& error) {
    throw Refusal("is not read: " + std::string(error.what()), "export the image again");
  }
}

}  // namespace

Texture decode_texture(std::span<const std::uint8_t> bytes, std::size_t most_texels) {
  if (starts_with(bytes, kPngMagic)) return decode_png(bytes, most_texels);
  if (starts_with(bytes, kJpegMagic)) return decode_jpeg(bytes, most_texels);
  throw Refusal("is neither PNG nor JPEG", "convert the image to PNG");
}

}  // namespace objects
