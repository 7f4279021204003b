#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>
#include <png.h>

#include "vpe/core/image/image.h"
#include "vpe/core/image/image_checks.h"
#include "vpe/core/image/png_stream.h"

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

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, int channels, int width, int height,
                                     int compression) {
  if (compression < 1 || compression > 9) {
    throw ImageError("PNG compression " + std::to_string(compression) + ": must be 1 to 9");
  }
  std::vector<std::uint8_t> out;
  constexpr std::size_t kOtherBytes = 128;
  // Few large pieces come, so that memory for each of them and the rest of the file saves copies.
  const auto sink = [&out](std::span<const std::uint8_t> bytes) {
    if (bytes.size() > kOtherBytes) out.reserve(out.size() + bytes.size() + kOtherBytes);
    out.insert(out.end(), bytes.begin(), bytes.end());
  };
  PngStreamOptions options;
  options.channels = channels;
  options.compression = compression;
  options.packing = PngPacking::kWhole;
  PngStream stream(width, height, options, sink);
  stream.write(pixels);
  stream.finish();
  return out;
}

// libjpeg reports errors by a call that must not return. The functions that are left by longjmp hold nothing
// that needs destroying; their callers own everything.
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
  return encode_png({reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size_bytes()}, 3, width,
                    height, compression);
}

std::vector<std::uint8_t> encode_png(std::span<const Rgba> pixels, int width, int height, int compression) {
  check_image_size(pixels.size(), width, height);
  return encode_png({reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size_bytes()}, 4, width,
                    height, compression);
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
                     "; make the image smaller");
  }
  return {encoder->bytes, encoder->bytes + encoder->size};
}

RgbImage decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t max_pixels) {
  // libjpeg treats an empty input as a fatal misuse.
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
