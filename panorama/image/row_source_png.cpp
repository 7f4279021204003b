#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "panorama/image/row_source.h"
#include "vpe/base/file.h"

namespace panorama {

namespace {

using vpe::base::file_error;

static_assert(sizeof(vpe::base::Rgb) == 3, "the library writes pixels in place");

// The functions that are left by longjmp hold nothing that needs destroying.
class PngRows : public RowSource {
 public:
  explicit PngRows(const std::filesystem::path& path) : PngRows(path, Closed()) {
    if (!start()) fail();
    if (is_interlaced_) {
      throw file_error("read", path, "it is interlaced, so that it has to be decoded in memory whole",
                       "give more --memory, or convert it: gdal_translate -of COG IN.png OUT.tif");
    }
  }
  ~PngRows() override { png_destroy_read_struct(&codec_, &info_, nullptr); }
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  std::int64_t width_px() const override { return width_px_; }
  std::int64_t height_px() const override { return height_px_; }
  void read(std::span<vpe::base::Rgb> row) override {
    if (!read_row(reinterpret_cast<png_bytep>(row.data()))) fail();
  }

 private:
  // Completes the object, so that its destructor runs when the delegating constructor throws.
  struct Closed {};
  PngRows(const std::filesystem::path& path, Closed)
      : path_(path), stream_(std::fopen(path.c_str(), "rb"), std::fclose) {
    if (stream_ == nullptr)
      throw file_error("read", path, std::strerror(errno), "check the name and the permissions");
  }

  [[noreturn]] static void leave(png_structp codec, png_const_charp message) {
    auto& self = *static_cast<PngRows*>(png_get_error_ptr(codec));
    std::snprintf(self.words_, sizeof self.words_, "%s", message);
    std::longjmp(self.escape_, 1);
  }
  static void ignore(png_structp /*codec*/, png_const_charp /*message*/) {}

  [[noreturn]] void fail() const {
    throw file_error("read", path_, words_, "the file is damaged or cut short");
  }

  bool start() {
    if (setjmp(escape_) != 0) return false;
    codec_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, leave, ignore);
    if (codec_ == nullptr) return false;
    info_ = png_create_info_struct(codec_);
    if (info_ == nullptr) return false;
    png_init_io(codec_, stream_.get());
    png_read_info(codec_, info_);
    width_px_ = png_get_image_width(codec_, info_);
    height_px_ = png_get_image_height(codec_, info_);
    is_interlaced_ = png_get_interlace_type(codec_, info_) != PNG_INTERLACE_NONE;
    if (is_interlaced_) return true;
    png_set_expand(codec_);
    png_set_scale_16(codec_);
    png_set_gray_to_rgb(codec_);
    png_set_strip_alpha(codec_);
    png_read_update_info(codec_, info_);
    if (png_get_rowbytes(codec_, info_) != std::size_t{3} * png_get_image_width(codec_, info_))
      png_error(codec_, "rows of unexpected size");
    return true;
  }

  bool read_row(png_bytep row) {
    if (setjmp(escape_) != 0) return false;
    png_read_row(codec_, row, nullptr);
    return true;
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  std::jmp_buf escape_{};
  char words_[128] = "unknown error";
  png_structp codec_ = nullptr;
  png_infop info_ = nullptr;
  std::int64_t width_px_ = 0;
  std::int64_t height_px_ = 0;
  bool is_interlaced_ = false;
};

}  // namespace

std::unique_ptr<RowSource> open_png_rows(const std::filesystem::path& path) {
  return std::make_unique<PngRows>(path);
}

}  // namespace panorama
