#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>

// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>

#include "panorama/image/row_source.h"
#include "vpe/base/file.h"

namespace panorama {

namespace {

using vpe::base::file_error;

// The functions that are left by longjmp hold nothing that needs destroying.
class JpegRows : public RowSource {
 public:
  explicit JpegRows(const std::filesystem::path& path) : JpegRows(path, Closed()) {
    if (!start()) fail();
    if (jpeg_has_multiple_scans(&codec_) != 0) {
      throw file_error("read", path, "it is progressive, so that it has to be decoded in memory whole",
                       "give more --memory, or convert it: gdal_translate -of COG IN.jpg OUT.tif");
    }
    if (!begin()) fail();
  }
  ~JpegRows() override { jpeg_destroy_decompress(&codec_); }
  JpegRows(const JpegRows&) = delete;
  JpegRows& operator=(const JpegRows&) = delete;

  std::int64_t width_px() const override { return codec_.output_width; }
  std::int64_t height_px() const override { return codec_.output_height; }
  void read(std::span<vpe::base::Rgb> row) override {
    if (!read_row(reinterpret_cast<JSAMPROW>(row.data()))) fail();
  }

 private:
  // Completes the object, so that its destructor runs when the delegating constructor throws.
  struct Closed {};
  JpegRows(const std::filesystem::path& path, Closed)
      : path_(path), stream_(std::fopen(path.c_str(), "rb"), std::fclose) {
    if (stream_ == nullptr)
      throw file_error("read", path, std::strerror(errno), "check the name and the permissions");
  }

  struct Errors {
    jpeg_error_mgr manager{};
    std::jmp_buf escape{};
    char words[JMSG_LENGTH_MAX] = "unknown error";
  };

  [[noreturn]] static void leave(j_common_ptr codec) {
    auto* errors = reinterpret_cast<Errors*>(codec->err);
    codec->err->format_message(codec, errors->words);
    std::longjmp(errors->escape, 1);
  }
  // Warnings (level -1) mean damaged data.
  static void leave_on_warning(j_common_ptr codec, int level) {
    if (level < 0) leave(codec);
  }

  [[noreturn]] void fail() const {
    throw file_error("read", path_, errors_.words, "the file is damaged or cut short");
  }

  bool start() {
    codec_.err = jpeg_std_error(&errors_.manager);
    errors_.manager.error_exit = leave;
    errors_.manager.emit_message = leave_on_warning;
    if (setjmp(errors_.escape) != 0) return false;
    jpeg_create_decompress(&codec_);
    jpeg_stdio_src(&codec_, stream_.get());
    jpeg_read_header(&codec_, TRUE);
    return true;
  }

  bool begin() {
    if (setjmp(errors_.escape) != 0) return false;
    codec_.out_color_space = JCS_RGB;
    jpeg_start_decompress(&codec_);
    return true;
  }

  bool read_row(JSAMPROW row) {
    if (setjmp(errors_.escape) != 0) return false;
    jpeg_read_scanlines(&codec_, &row, 1);
    return true;
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  Errors errors_;
  jpeg_decompress_struct codec_{};
};

}  // namespace

std::unique_ptr<RowSource> open_jpeg_rows(const std::filesystem::path& path) {
  return std::make_unique<JpegRows>(path);
}

}  // namespace panorama
