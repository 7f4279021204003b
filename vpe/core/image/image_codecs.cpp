#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>
#include <png.h>

#include "vpe/core/image/image.h"
#include "vpe/core/image/image_checks.h"
#include "vpe/core/image/png_packer.h"

namespace vpe::core {

namespace {

static_assert(sizeof(base::Rgb) == 3 && sizeof(Rgba) == 4, "codecs write pixels in place");

constexpr char kDamagedAdvice[] = "; the data are damaged or of another kind";

struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(this); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

// libpng and libjpeg report errors by a call that must not return. The functions that are left by longjmp hold
// nothing that needs destroying; their callers own everything.
struct PngEncoder {
  std::vector<std::uint8_t> bytes;
  std::jmp_buf escape{};
  char words[128] = "unknown error";
  png_structp codec = nullptr;
  png_infop info = nullptr;

  ~PngEncoder() { png_destroy_write_struct(&codec, &info); }

  static PngEncoder& self(png_structp codec) { return *static_cast<PngEncoder*>(png_get_error_ptr(codec)); }

  [[noreturn]] static void leave(png_structp codec, png_const_charp message) {
    std::snprintf(self(codec).words, sizeof words, "%s", message);
    std::longjmp(self(codec).escape, 1);
  }

  static void ignore(png_structp /*codec*/, png_const_charp /*message*/) {}
  static void flush(png_structp /*codec*/) {}

  static void append(png_structp codec, png_bytep data, std::size_t size) {
    // No exception may pass through the library.
    try {
      self(codec).bytes.insert(self(codec).bytes.end(), data, data + size);
      return;
    } catch (const std::bad_alloc&) {
    }
    png_error(codec, "out of memory");
  }

  bool run(const std::uint8_t* pixels, int color_type, int width, int height, int compression) {
    if (setjmp(escape) != 0) return false;
    codec = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, leave, ignore);
    if (codec == nullptr) return false;
    info = png_create_info_struct(codec);
    if (info == nullptr) return false;
    png_set_write_fn(codec, nullptr, append, flush);
    png_set_IHDR(codec, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, color_type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(codec, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_filter(codec, PNG_FILTER_TYPE_BASE, PNG_FAST_FILTERS);
    png_set_compression_level(codec, compression);
    png_write_info(codec, info);
    const std::size_t row_bytes = png_get_rowbytes(codec, info);
    for (int y = 0; y < height; ++y) png_write_row(codec, pixels + static_cast<std::size_t>(y) * row_bytes);
    png_write_end(codec, nullptr);
    return true;
  }
};

std::vector<std::uint8_t> encode_png(const void* pixels, int color_type, int width, int height,
                                     int compression) {
  if (compression < 1 || compression > 9) {
    throw ImageError("PNG compression " + std::to_string(compression) + ": must be 1 to 9");
  }
  const bool has_alpha = color_type == PNG_COLOR_TYPE_RGBA;
  const std::size_t channels = has_alpha ? 4 : 3;
  if (can_pack_png(channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))) {
    return pack_png(static_cast<const std::uint8_t*>(pixels), static_cast<int>(channels), width, height,
                    compression);
  }
  const auto encoder = std::make_unique<PngEncoder>();
  if (!encoder->run(static_cast<const std::uint8_t*>(pixels), color_type, width, height, compression)) {
    throw ImageError(std::string("cannot encode a PNG: ") + encoder->words + "; make the picture smaller");
  }
  return std::move(encoder->bytes);
}

struct JpegErrors {
  jpeg_error_mgr manager{};
  std::jmp_buf escape{};
  char words[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void leave(j_common_ptr codec) {
  auto* errors = reinterpret_cast<JpegErrors*>(codec->err);
  codec->err->format_message(codec, errors->words);
  std::longjmp(errors->escape, 1);
}

// Warnings (level -1) mean damaged data.
void leave_on_warning(j_common_ptr codec, int level) {
  if (level < 0) leave(codec);
}

jpeg_error_mgr* install(JpegErrors& errors) {
  jpeg_error_mgr* manager = jpeg_std_error(&errors.manager);
  manager->error_exit = leave;
  manager->emit_message = leave_on_warning;
  return manager;
}

struct JpegEncoder {
  JpegErrors errors;
  jpeg_compress_struct codec{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libjpeg's own type

  ~JpegEncoder() {
    jpeg_destroy_compress(&codec);
    std::free(bytes);
  }

  bool run(const base::Rgb* pixels, int width, int height, int quality) {
    codec.err = install(errors);
    if (setjmp(errors.escape) != 0) return false;
    jpeg_create_compress(&codec);
    jpeg_mem_dest(&codec, &bytes, &size);
    codec.image_width = static_cast<JDIMENSION>(width);
    codec.image_height = static_cast<JDIMENSION>(height);
    codec.input_components = 3;
    codec.in_color_space = JCS_RGB;
    jpeg_set_defaults(&codec);
    jpeg_set_quality(&codec, quality, TRUE);
    if (quality >= 90) codec.comp_info[0].h_samp_factor = codec.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&codec, TRUE);
    while (codec.next_scanline < codec.image_height) {
      const base::Rgb* row =
          pixels + static_cast<std::size_t>(codec.next_scanline) * static_cast<std::size_t>(width);
      auto* samples = reinterpret_cast<JSAMPLE*>(const_cast<base::Rgb*>(row));
      jpeg_write_scanlines(&codec, &samples, 1);
    }
    jpeg_finish_compress(&codec);
    return true;
  }
};

struct JpegDecoder {
  JpegErrors errors;
  jpeg_decompress_struct codec{};

  ~JpegDecoder() { jpeg_destroy_decompress(&codec); }

  bool read_header(std::span<const std::uint8_t> bytes) {
    codec.err = install(errors);
    if (setjmp(errors.escape) != 0) return false;
    jpeg_create_decompress(&codec);
    jpeg_mem_src(&codec, bytes.data(), bytes.size());
    jpeg_read_header(&codec, TRUE);
    codec.out_color_space = JCS_RGB;
    return true;
  }

  bool read_pixels(base::Rgb* pixels) {
    if (setjmp(errors.escape) != 0) return false;
    jpeg_start_decompress(&codec);
    while (codec.output_scanline < codec.output_height) {
      auto* samples =
          reinterpret_cast<JSAMPLE*>(pixels + std::size_t{codec.output_scanline} * codec.output_width);
      jpeg_read_scanlines(&codec, &samples, 1);
    }
    jpeg_finish_decompress(&codec);
    return true;
  }
};

[[noreturn]] void throw_damaged(const char* kind, const char* words) {
  throw ImageError(std::string("cannot decode a ") + kind + ": " + words + kDamagedAdvice);
}

}  // namespace

std::vector<std::uint8_t> encode_png(std::span<const base::Rgb> pixels, int width, int height,
                                     int compression) {
  check_image_size(pixels.size(), width, height);
  return encode_png(pixels.data(), PNG_COLOR_TYPE_RGB, width, height, compression);
}

std::vector<std::uint8_t> encode_png(std::span<const Rgba> pixels, int width, int height, int compression) {
  check_image_size(pixels.size(), width, height);
  return encode_png(pixels.data(), PNG_COLOR_TYPE_RGBA, width, height, compression);
}

RgbImage decode_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels) {
  PngImage image;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    throw_damaged("PNG", image.message);
  check_read_size(image.width, image.height, max_pixels);
  // Read with alpha, then drop it: read without, libpng would blend with a background.
  image.format = PNG_FORMAT_RGBA;
  std::vector<Rgba> pixels(std::size_t{image.width} * image.height);
  const int width = static_cast<int>(image.width);
  const int height = static_cast<int>(image.height);
  if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0)
    throw_damaged("PNG", image.message);
  RgbImage result{width, height, {}};
  result.pixels.reserve(pixels.size());
  for (const Rgba& p : pixels) result.pixels.push_back({p.r, p.g, p.b});
  return result;
}

std::vector<std::uint8_t> encode_jpeg(std::span<const base::Rgb> pixels, int width, int height, int quality) {
  check_image_size(pixels.size(), width, height);
  if (quality < 1 || quality > 100) {
    throw ImageError("JPEG quality " + std::to_string(quality) + ": must be 1 to 100");
  }
  const auto encoder = std::make_unique<JpegEncoder>();
  if (!encoder->run(pixels.data(), width, height, quality)) {
    throw ImageError(std::string("cannot encode a JPEG: ") + encoder->errors.words +
                     "; make the picture smaller");
  }
  return {encoder->bytes, encoder->bytes + encoder->size};
}

RgbImage decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t max_pixels) {
  // libjpeg calls an empty input a fatal misuse.
  if (bytes.empty()) throw_damaged("JPEG", "no data");
  const auto decoder = std::make_unique<JpegDecoder>();
  if (!decoder->read_header(bytes)) throw_damaged("JPEG", decoder->errors.words);
  check_read_size(decoder->codec.image_width, decoder->codec.image_height, max_pixels);
  RgbImage result{
      static_cast<int>(decoder->codec.image_width), static_cast<int>(decoder->codec.image_height), {}};
  result.pixels.resize(std::size_t{decoder->codec.image_width} * decoder->codec.image_height);
  if (!decoder->read_pixels(result.pixels.data())) throw_damaged("JPEG", decoder->errors.words);
  return result;
}

}  // namespace vpe::core
