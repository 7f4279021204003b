#include "panorama/tiff_file.h"

#include <cstdio>
#include <utility>

namespace panorama {

namespace {

// A picture of 100 000 x 20 000 in tiles of 16 x 16 has tables of 60 MB.
constexpr tmsize_t kMaxTableBytes = tmsize_t{1} << 28;

}  // namespace

int TiffFile::keep_words(TIFF* /*tiff*/, void* user, const char* /*module*/, const char* format,
                         std::va_list arguments) {
  std::vsnprintf(static_cast<Words*>(user)->text, sizeof Words::text, format, arguments);
  return 1;
}

int TiffFile::ignore_words(TIFF* /*tiff*/, void* /*user*/, const char* /*module*/, const char* /*format*/,
                           std::va_list /*arguments*/) {
  return 1;
}

TiffFile::TiffFile(std::filesystem::path path) : path_(std::move(path)) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_words, words_.get());
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_words, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxTableBytes);
  // m: no memory map; O: tables of strips and tiles only when asked for.
  tiff_.reset(TIFFOpenExt(path_.c_str(), "rmO", options.get()));
  if (tiff_ == nullptr) throw damaged();
}

vpe::core::FileError TiffFile::damaged() const {
  return vpe::core::file_error("read", path_, words_->text, "the file is damaged, cut short, or no TIFF");
}

}  // namespace panorama
