#include "vpe/core/image/tiff_handle.h"

#include <cstdarg>

namespace vpe::core {

namespace {

template <std::size_t size>
int keep_words(TIFF* /*tiff*/, void* user, const char* /*module*/, const char* format, std::va_list arguments) {
  std::vsnprintf(static_cast<char*>(user), size, format, arguments);
  return 1;
}

int ignore_words(TIFF* /*tiff*/, void* /*user*/, const char* /*module*/, const char* /*format*/,
                 std::va_list /*arguments*/) {
  return 1;
}

using Options = std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)>;

template <std::size_t size>
Options options_for(char (&words)[size]) {
  Options options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_words<size>, words);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_words, nullptr);
  return options;
}

std::FILE* stream_of(thandle_t handle) { return static_cast<std::FILE*>(handle); }

tmsize_t read_bytes(thandle_t handle, void* data, tmsize_t size) {
  return static_cast<tmsize_t>(std::fread(data, 1, static_cast<std::size_t>(size), stream_of(handle)));
}

tmsize_t write_bytes(thandle_t handle, void* data, tmsize_t size) {
  return static_cast<tmsize_t>(std::fwrite(data, 1, static_cast<std::size_t>(size), stream_of(handle)));
}

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  if (fseeko(stream_of(handle), static_cast<off_t>(offset), whence) != 0) return static_cast<toff_t>(-1);
  return static_cast<toff_t>(ftello(stream_of(handle)));
}

int leave_open(thandle_t /*handle*/) { return 0; }

toff_t size_of(thandle_t handle) {
  const off_t here = ftello(stream_of(handle));
  fseeko(stream_of(handle), 0, SEEK_END);
  const off_t size = ftello(stream_of(handle));
  fseeko(stream_of(handle), here, SEEK_SET);
  return static_cast<toff_t>(size);
}

int no_map(thandle_t /*handle*/, void** /*base*/, toff_t* /*size*/) { return 0; }
void no_unmap(thandle_t /*handle*/, void* /*base*/, toff_t /*size*/) {}

}  // namespace

TiffHandle::TiffHandle(const std::filesystem::path& path, const char* mode, tmsize_t max_bytes) {
  const Options options = options_for(words_->text);
  if (max_bytes > kNoLimit) TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), max_bytes);
  tiff_.reset(TIFFOpenExt(path.c_str(), mode, options.get()));
}

TiffHandle::TiffHandle(std::FILE* stream, const std::filesystem::path& path, const char* mode) {
  const Options options = options_for(words_->text);
  tiff_.reset(TIFFClientOpenExt(path.c_str(), mode, stream, read_bytes, write_bytes, seek, leave_open, size_of,
                                no_map, no_unmap, options.get()));
}

bool set_layout(TIFF* tiff, const TiffLayout& layout) {
  const auto set = [tiff](std::uint32_t tag, auto value) { return TIFFSetField(tiff, tag, value) == 1; };
  const bool is_float = layout.bits != 8;
  const bool is_rgb = layout.samples == 3 && !is_float;
  bool ok = set(TIFFTAG_IMAGEWIDTH, layout.width_px) && set(TIFFTAG_IMAGELENGTH, layout.height_px) &&
            set(TIFFTAG_BITSPERSAMPLE, layout.bits) && set(TIFFTAG_SAMPLESPERPIXEL, layout.samples) &&
            set(TIFFTAG_SAMPLEFORMAT, is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT) &&
            set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
            set(TIFFTAG_PHOTOMETRIC, is_rgb ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK) &&
            set(TIFFTAG_COMPRESSION, layout.compression);
  if (layout.compression != COMPRESSION_NONE)
    ok = ok && set(TIFFTAG_PREDICTOR, is_float ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
  if (layout.tile_width_px == 0) return ok && set(TIFFTAG_ROWSPERSTRIP, layout.tile_height_px);
  return ok && set(TIFFTAG_TILEWIDTH, layout.tile_width_px) && set(TIFFTAG_TILELENGTH, layout.tile_height_px);
}

}  // namespace vpe::core
