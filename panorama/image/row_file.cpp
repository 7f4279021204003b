#include "panorama/image/row_file.h"

#include <csetjmp>
#include <cstdio>
#include <stdexcept>

// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>

#include "panorama/image/xmp_file.h"
#include "vpe/core/image/png_stream.h"

namespace panorama {

namespace {

// libjpeg reports errors by a call that must not return. The functions that are left by longjmp hold nothing
// that needs destroying.
struct Errors {
  jpeg_error_mgr manager{};
  std::jmp_buf escape{};
  char words[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void leave(j_common_ptr codec) {
  auto* errors = reinterpret_cast<Errors*>(codec->err);
  codec->err->format_message(codec, errors->words);
  std::longjmp(errors->escape, 1);
}

class PngWriter : public RowWriter {
 public:
  PngWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px, const std::string& xmp,
            vpe::base::ThreadPool& pool)
      : stream_(width_px, height_px, options_for(xmp, pool),
                [&file](std::span<const std::uint8_t> bytes) { file.write(bytes); }) {}

  void write(std::span<const vpe::base::Rgb> rows) override {
    stream_.write({reinterpret_cast<const std::uint8_t*>(rows.data()), rows.size_bytes()});
  }
  void finish() override { stream_.finish(); }

 private:
  static vpe::core::PngStreamOptions options_for(const std::string& xmp, vpe::base::ThreadPool& pool) {
    vpe::core::PngStreamOptions options;
    options.xmp = xmp;
    options.pool = &pool;
    return options;
  }

  vpe::core::PngStream stream_;
};

class JpegWriter : public RowWriter {
 public:
  JpegWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px, const std::string& xmp,
             int quality)
      : file_(file), width_px_(static_cast<std::size_t>(width_px)) {
    codec_.err = jpeg_std_error(&errors_.manager);
    errors_.manager.error_exit = leave;
    std::string marker("http://ns.adobe.com/xap/1.0/");
    marker += '\0';
    marker += xmp;
    if (xmp.size() > kMaxJpegXmpBytes) throw std::logic_error("an XMP packet that no JPEG holds");
    if (!begin(width_px, height_px, xmp.empty() ? nullptr : &marker, quality)) fail();
  }
  ~JpegWriter() override { jpeg_destroy_compress(&codec_); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  void write(std::span<const vpe::base::Rgb> rows) override {
    const std::size_t count = rows.size() / width_px_;
    if (count * width_px_ != rows.size() || count > codec_.image_height - codec_.next_scanline) {
      throw std::logic_error("not the rows of this image");
    }
    if (!write(rows.data(), count)) fail();
  }

  void finish() override {
    if (codec_.next_scanline != codec_.image_height) throw std::logic_error("rows are missing");
    if (!end()) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw vpe::base::file_error("write", file_.path(), errors_.words,
                                "check the free space and the permissions there");
  }

  bool begin(std::int64_t width_px, std::int64_t height_px, const std::string* marker, int quality) {
    if (setjmp(errors_.escape) != 0) return false;
    jpeg_create_compress(&codec_);
    jpeg_stdio_dest(&codec_, file_.stream());
    codec_.image_width = static_cast<JDIMENSION>(width_px);
    codec_.image_height = static_cast<JDIMENSION>(height_px);
    codec_.input_components = 3;
    codec_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&codec_);
    jpeg_set_quality(&codec_, quality, TRUE);
    codec_.comp_info[0].h_samp_factor = codec_.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&codec_, TRUE);
    if (marker != nullptr) {
      jpeg_write_marker(&codec_, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(marker->data()),
                        static_cast<unsigned>(marker->size()));
    }
    return true;
  }

  bool write(const vpe::base::Rgb* rows, std::size_t count) {
    if (setjmp(errors_.escape) != 0) return false;
    for (std::size_t y = 0; y < count; ++y) {
      auto* row = reinterpret_cast<JSAMPLE*>(const_cast<vpe::base::Rgb*>(rows + y * width_px_));
      jpeg_write_scanlines(&codec_, &row, 1);
    }
    return true;
  }

  bool end() {
    if (setjmp(errors_.escape) != 0) return false;
    jpeg_finish_compress(&codec_);
    return true;
  }

  vpe::base::OutputFile& file_;
  std::size_t width_px_;
  Errors errors_;
  jpeg_compress_struct codec_{};
};

}  // namespace

std::unique_ptr<RowWriter> make_png_writer(vpe::base::OutputFile& file, std::int64_t width_px,
                                           std::int64_t height_px, const std::string& xmp,
                                           vpe::base::ThreadPool& pool) {
  return std::make_unique<PngWriter>(file, width_px, height_px, xmp, pool);
}

std::unique_ptr<RowWriter> make_jpeg_writer(vpe::base::OutputFile& file, std::int64_t width_px,
                                            std::int64_t height_px, const std::string& xmp, int quality) {
  return std::make_unique<JpegWriter>(file, width_px, height_px, xmp, quality);
}

}  // namespace panorama
